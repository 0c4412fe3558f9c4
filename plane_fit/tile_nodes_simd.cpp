// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/plane_fit/tile_kernels_scalar.h"
#include "planecloud_slam/plane_fit/tile_kernels_simd.h"

// Compiled once for every instruction set that Highway knows here, chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "planecloud_slam/plane_fit/tile_nodes_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace planecloud::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Sums of groups of four neighbouring columns, one group a lane.
template <class D>
hn::Vec<D> sumOfFours(D d, const float* columns) {
  hn::Vec<D> a, b, c, e;
  hn::LoadInterleaved4(d, columns, a, b, c, e);
  return hn::Add(hn::Add(a, b), hn::Add(c, e));
}

#if HWY_TARGET != HWY_SCALAR  // one lane has no halves
/// sum of q^2 - (sum of q)^2 / n, a small difference of large numbers: in double.
template <class D>
hn::Vec<D> centredSquares(D d, hn::Vec<D> q, hn::Vec<D> qq, hn::Vec<D> inverse_n) {
  const hn::RepartitionToWide<D> wide;
  const hn::Half<D> half;
  const auto centre = [&](auto q_half, auto qq_half, auto inverse_half) {
    const auto wide_q = hn::PromoteTo(wide, q_half);
    const auto mean = hn::Mul(wide_q, hn::PromoteTo(wide, inverse_half));
    return hn::DemoteTo(half, hn::NegMulAdd(mean, wide_q, hn::PromoteTo(wide, qq_half)));
  };
  const auto lower = centre(hn::LowerHalf(q), hn::LowerHalf(qq), hn::LowerHalf(inverse_n));
  const auto upper =
      centre(hn::UpperHalf(half, q), hn::UpperHalf(half, qq), hn::UpperHalf(half, inverse_n));
  return hn::Combine(d, upper, lower);
}

/// See DistortionRule::weigh; -1 where the plane is not in front.
template <class D>
hn::Vec<D> weigh(D d, const DistortionRule& rule, hn::Vec<D> n, hn::Vec<D> mean, hn::Vec<D> rms,
                 hn::Mask<D> in_front) {
  const auto one = hn::Set(d, 1.0F);
  const auto depth = hn::Div(one, hn::IfThenElse(in_front, mean, one));
  auto scale = hn::Mul(hn::Set(d, rule.factor), n);
  for (int power = 0; power < rule.depth_power; ++power) scale = hn::Mul(scale, depth);
  return hn::IfThenElse(in_front, hn::Mul(scale, rms), hn::Set(d, -1.0F));
}

template <class D>
void storeFills(D d, hn::Vec<D> counts, hn::Vec<D> areas, Fill* fills) {
  const hn::Rebind<std::int32_t, D> di32;
  const hn::Rebind<std::uint8_t, D> du8;
  const auto one = hn::Set(d, 1.0F);
  const auto some = hn::IfThenElseZero(hn::Gt(counts, hn::Zero(d)), one);
  const auto all = hn::IfThenElseZero(hn::Eq(counts, areas), some);
  const auto values = hn::DemoteTo(du8, hn::ConvertTo(di32, hn::Add(some, all)));
  hn::StoreU(values, du8, reinterpret_cast<std::uint8_t*>(fills));
}

/// Sums of cells, one a lane; `qx` counts columns from the cell's first.
template <class V>
struct CellVectors {
  V n, q, qx, qy, qq;
};

/// Of cells four columns wide, from column x on.
template <class D>
HWY_INLINE CellVectors<hn::Vec<D>> sumFours(D d, const ColumnSums& columns, int x) {
  hn::Vec<D> a, b, c, e;
  hn::LoadInterleaved4(d, columns.q + x, a, b, c, e);
  const auto last = hn::Add(c, e);
  return {sumOfFours(d, columns.n + x), hn::Add(hn::Add(a, b), last),
          hn::MulAdd(hn::Set(d, 2.0F), last, hn::Add(b, e)), sumOfFours(d, columns.qy + x),
          sumOfFours(d, columns.qq + x)};
}

/// Of cells `kWidth` columns wide.
template <int kWidth, class D>
HWY_INLINE CellVectors<hn::Vec<D>> sumColumnsOfCells(D d, const ColumnSums& columns, int x) {
  static_assert(kWidth == 4 || kWidth == 8);
  const auto first = sumFours(d, columns, x);
  if constexpr (kWidth == 4) return first;
  // Left and right halves of cells take turns.
  const auto last = sumFours(d, columns, x + 4 * static_cast<int>(hn::Lanes(d)));
  const auto left = [&](auto upper, auto lower) { return hn::ConcatEven(d, upper, lower); };
  const auto right = [&](auto upper, auto lower) { return hn::ConcatOdd(d, upper, lower); };
  const auto both = [&](auto upper, auto lower) {
    return hn::Add(left(upper, lower), right(upper, lower));
  };
  return {both(last.n, first.n), both(last.q, first.q),
          hn::MulAdd(hn::Set(d, 4.0F), right(last.q, first.q), both(last.qx, first.qx)),
          both(last.qy, first.qy), both(last.qq, first.qq)};
}

/// Sums cells that are alike, whole vectors of them, from the cell `first` on. Returns where it
/// ended.
template <int kWidth, class D>
int sumAlike(D d, const ColumnSums& columns, const CellRow& row, const DistortionRule& rule,
             int first, const CellSums& sums) {
  const int lanes = static_cast<int>(hn::Lanes(d));
  const CellTangents& t = row.tangents;
  const auto constant = [&](double value) { return hn::Set(d, static_cast<float>(value)); };
  const auto n = constant(kWidth * row.height);
  const auto inverse_n = constant(1.0 / (kWidth * row.height));
  const auto half_width = constant(0.5 * (kWidth - 1));
  const auto half_height = constant(0.5 * (row.height - 1));
  const auto inverse_spread_x = constant(1.0 / (row.height * scalar::spread(kWidth)));
  const auto inverse_spread_y =
      constant(row.height > 1 ? 1.0 / (kWidth * scalar::spread(row.height)) : 0.0);
  int cell = first;
  for (; cell + lanes <= row.alike; cell += lanes) {
    const auto tangents = [&](const float* values) { return hn::LoadU(d, values + cell); };
    const auto sum = sumColumnsOfCells<kWidth>(d, columns, row.edges[cell]);
    const auto qu =
        hn::MulAdd(tangents(t.u), sum.q,
                   hn::MulAdd(tangents(t.u_right), sum.qx, hn::Mul(tangents(t.u_down), sum.qy)));
    const auto qv =
        hn::MulAdd(tangents(t.v), sum.q,
                   hn::MulAdd(tangents(t.v_right), sum.qx, hn::Mul(tangents(t.v_down), sum.qy)));
    hn::StoreU(sum.n, d, sums.counts + cell);
    storeFills(d, sum.n, n, sums.fills + cell);
    hn::StoreInterleaved4(sum.q, qu, qv, sum.qq, d, &sums.depth[cell].q);

    const auto centred_x = hn::NegMulAdd(half_width, sum.q, sum.qx);
    const auto centred_y = hn::NegMulAdd(half_height, sum.q, sum.qy);
    const auto right = hn::Mul(centred_x, inverse_spread_x);
    const auto down = hn::Mul(centred_y, inverse_spread_y);
    auto squares = centredSquares(d, sum.q, sum.qq, inverse_n);
    squares = hn::NegMulAdd(right, centred_x, hn::NegMulAdd(down, centred_y, squares));
    const auto rms = hn::Sqrt(hn::Max(hn::Zero(d), hn::Mul(squares, inverse_n)));
    const auto mean = hn::Mul(sum.q, inverse_n);
    const auto reach = hn::MulAdd(hn::Abs(right), half_width, hn::Mul(hn::Abs(down), half_height));
    const auto in_front = hn::Ge(hn::Sub(mean, reach), hn::Set(d, kMinPlaneInverseDepth));
    hn::StoreU(weigh(d, rule, n, mean, rms, in_front), d, sums.distortions + cell);
  }
  return cell;
}

/// How many cells were summed, from the first on: vectors are whole, and cells 4 or 8 pixels wide.
int sumVectors(const ColumnSums& columns, const CellRow& row, const DistortionRule& rule,
               const CellSums& sums) {
  const hn::ScalableTag<float> d;
  const hn::CappedTag<float, 4> d4;  // as many as a node has quarters
  const int width = row.alike > 0 ? row.edges[1] - row.edges[0] : 0;
  if (width == 8) return sumAlike<8>(d, columns, row, rule, 0, sums);
  if (width != 4) return 0;
  return sumAlike<4>(d4, columns, row, rule, sumAlike<4>(d, columns, row, rule, 0, sums), sums);
}

/// How many of the nodes were regressed: whole vectors.
std::size_t regressVectors(const DepthSums* sums, const FullNodeRows& nodes,
                           const DistortionRule& rule, std::size_t count, const PlaneFits& fits) {
  const hn::ScalableTag<float> d;
  const std::size_t lanes = hn::Lanes(d);
  const auto load = [&](const float* values) { return hn::LoadU(d, values); };
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes) {
    hn::Vec<decltype(d)> q, sum_qu, sum_qv, qq;
    hn::LoadInterleaved4(d, &sums[i].q, q, sum_qu, sum_qv, qq);
    const auto inverse_n = load(nodes.inverse_n + i);
    const auto mean_u = load(nodes.mean_u + i);
    const auto mean_v = load(nodes.mean_v + i);
    const auto inverse_uv = load(nodes.inverse_uv + i);
    const auto mean = hn::Mul(q, inverse_n);
    const auto qu = hn::NegMulAdd(mean_u, q, sum_qu);
    const auto qv = hn::NegMulAdd(mean_v, q, sum_qv);
    const auto alpha = hn::MulAdd(load(nodes.inverse_uu + i), qu, hn::Mul(inverse_uv, qv));
    const auto beta = hn::MulAdd(inverse_uv, qu, hn::Mul(load(nodes.inverse_vv + i), qv));
    auto squares = centredSquares(d, q, qq, inverse_n);
    squares = hn::NegMulAdd(alpha, qu, hn::NegMulAdd(beta, qv, squares));
    const auto reach = hn::MulAdd(hn::Abs(alpha), load(nodes.reach_u + i),
                                  hn::Mul(hn::Abs(beta), load(nodes.reach_v + i)));
    const auto gamma = hn::NegMulAdd(alpha, mean_u, hn::NegMulAdd(beta, mean_v, mean));
    const auto rms = hn::Sqrt(hn::Max(hn::Zero(d), hn::Mul(squares, inverse_n)));
    const auto in_front = hn::Ge(hn::Sub(mean, reach), hn::Set(d, kMinPlaneInverseDepth));
    hn::StoreInterleaved4(alpha, beta, gamma, hn::IfThenElse(in_front, rms, hn::Neg(rms)), d,
                          &fits.planes[i].alpha);
    hn::StoreU(weigh(d, rule, load(nodes.n + i), mean, rms, in_front), d, fits.distortions + i);
  }
  return i;
}
#else
int sumVectors(const ColumnSums&, const CellRow&, const DistortionRule&, const CellSums&) {
  return 0;
}
std::size_t regressVectors(const DepthSums*, const FullNodeRows&, const DistortionRule&,
                           std::size_t, const PlaneFits&) {
  return 0;
}
#endif

void sumCells(const ColumnSums& columns, const CellRow& row, const DistortionRule& rule,
              const CellSums& sums) {
  scalar::sumCells(columns, row, rule, sumVectors(columns, row, rule, sums), sums);
}

void regress(const DepthSums* sums, const FullNodeRows& nodes, const DistortionRule& rule,
             std::size_t count, const PlaneFits& fits) {
  scalar::regress(sums, nodes, rule, regressVectors(sums, nodes, rule, count, fits), count, fits);
}

/// See regressInverseDepth.
void regressMoments(const MomentRows& m, const PlaneRows& planes, std::size_t count) {
  const hn::ScalableTag<double> d;
  const std::size_t lanes = hn::Lanes(d);
  const auto zero = hn::Zero(d);
  const auto one = hn::Set(d, 1.0);
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes) {
    const auto load = [&](const double* values) { return hn::LoadU(d, values + i); };
    const auto n = load(m.n), u = load(m.u), v = load(m.v), q = load(m.q);
    const auto raw_uu = load(m.uu), raw_vv = load(m.vv);
    const auto inverse_n = hn::Div(one, n);
    const auto mean_u = hn::Mul(u, inverse_n);
    const auto mean_v = hn::Mul(v, inverse_n);
    const auto uu = hn::NegMulAdd(u, mean_u, raw_uu);
    const auto uv = hn::NegMulAdd(u, mean_v, load(m.uv));
    const auto vv = hn::NegMulAdd(v, mean_v, raw_vv);
    const auto trace = hn::Add(uu, vv);
    const auto square = hn::Mul(trace, trace);
    const auto det = hn::NegMulAdd(uv, uv, hn::Mul(uu, vv));
    const auto regular = hn::Gt(det, hn::Mul(hn::Set(d, kMinSpreadRatio), square));
    const auto rounding = hn::Mul(hn::Set(d, kRoundingSpreadRatio), hn::Add(raw_uu, raw_vv));
    const auto spread = hn::And(hn::Gt(trace, rounding), hn::Ge(n, hn::Set(d, 2.0)));
    const auto known = hn::Or(regular, spread);
    const auto scale = hn::IfThenElseZero(
        known, hn::Div(one, hn::IfThenElse(regular, det, hn::IfThenElse(known, square, one))));
    const auto inverse_uu = hn::Mul(scale, hn::IfThenElse(regular, vv, uu));
    const auto inverse_uv = hn::Mul(scale, hn::IfThenElse(regular, hn::Neg(uv), uv));
    const auto inverse_vv = hn::Mul(scale, hn::IfThenElse(regular, uu, vv));
    const auto raw_qu = load(m.qu), raw_qv = load(m.qv);
    const auto qu = hn::NegMulAdd(mean_u, q, raw_qu);
    const auto qv = hn::NegMulAdd(mean_v, q, raw_qv);
    const auto alpha = hn::MulAdd(inverse_uu, qu, hn::Mul(inverse_uv, qv));
    const auto beta = hn::MulAdd(inverse_uv, qu, hn::Mul(inverse_vv, qv));
    const auto gamma = hn::Mul(hn::NegMulAdd(alpha, u, hn::NegMulAdd(beta, v, q)), inverse_n);
    const auto squares = hn::NegMulAdd(
        alpha, raw_qu, hn::NegMulAdd(beta, raw_qv, hn::NegMulAdd(gamma, q, load(m.qq))));
    hn::StoreU(alpha, d, planes.alpha + i);
    hn::StoreU(beta, d, planes.beta + i);
    hn::StoreU(gamma, d, planes.gamma + i);
    hn::StoreU(hn::Sqrt(hn::Max(zero, hn::Mul(squares, inverse_n))), d, planes.rms + i);
  }
  scalar::regressMoments(m, planes, i, count);
}

void addNodeKernels(TileKernels& kernels) {
  kernels.name = hwy::TargetName(HWY_TARGET);
  kernels.sum_cells = &sumCells;
  kernels.regress = &regress;
  kernels.regress_moments = &regressMoments;
}

}  // namespace planecloud::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace planecloud {

HWY_EXPORT(addNodeKernels);

const TileKernels& vectorTileKernels() {
  static const TileKernels kernels = [] {
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    TileKernels chosen{};
    HWY_DYNAMIC_DISPATCH(addNodeKernels)(chosen);
    addVectorPixelKernels(chosen);
    return chosen;
  }();
  return kernels;
}

}  // namespace planecloud
#endif  // HWY_ONCE

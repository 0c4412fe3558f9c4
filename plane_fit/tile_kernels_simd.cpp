// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/plane_fit/tile_kernels_scalar.h"

// Compiled once for every instruction set that Highway knows here, chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "planecloud_slam/plane_fit/tile_kernels_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace planecloud::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Inverse depth [1/m] of a vector of pixels, 0 where there is none (see DepthTraits).
template <class D>
hn::Vec<D> loadInverse(D d, const float* depth) {
  const hn::Vec<D> z = hn::LoadU(d, depth);
  const auto valid = hn::And(hn::Ge(z, hn::Set(d, kMinDepth)), hn::Le(z, hn::Set(d, kMaxDepth)));
  return hn::IfThenElseZero(valid, hn::Div(hn::Set(d, 1.0F), z));
}

template <class D>
hn::Vec<D> loadInverse(D d, const std::uint16_t* depth) {
  const hn::Rebind<std::uint16_t, D> du16;
  const hn::Rebind<std::int32_t, D> di32;
  const hn::Vec<D> z = hn::ConvertTo(d, hn::PromoteTo(di32, hn::LoadU(du16, depth)));
  const auto valid = hn::Ge(z, hn::Set(d, kMinDepth * 1000.0F));
  return hn::IfThenElseZero(valid, hn::Div(hn::Set(d, 1000.0F), z));
}

template <typename Pixel>
void sumColumns(const DepthStrip<Pixel>& strip, const ColumnSums& sums) {
  const hn::ScalableTag<float> d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const auto zero = hn::Zero(d);
  const auto one = hn::Set(d, 1.0F);
  int x = 0;
  for (; x + lanes <= strip.width; x += lanes) {
    auto n = zero, q = zero, qu = zero, qv = zero, qq = zero;
    for (int y = 0; y < strip.rows; ++y) {
      const auto value = loadInverse(d, strip.depth + y * strip.depth_stride + x);
      const std::ptrdiff_t at = y * strip.tangents.stride + x;
      hn::StoreU(value, d, strip.inverse_depth + at);
      n = hn::Add(n, hn::IfThenElseZero(hn::Gt(value, zero), one));
      q = hn::Add(q, value);
      qu = hn::MulAdd(value, hn::LoadU(d, strip.tangents.u + at), qu);
      qv = hn::MulAdd(value, hn::LoadU(d, strip.tangents.v + at), qv);
      qq = hn::MulAdd(value, value, qq);
    }
    hn::StoreU(n, d, sums.n + x);
    hn::StoreU(q, d, sums.q + x);
    hn::StoreU(qu, d, sums.qu + x);
    hn::StoreU(qv, d, sums.qv + x);
    hn::StoreU(qq, d, sums.qq + x);
  }
  scalar::sumColumns(strip, sums, x);
}

void sumColumnsF32(const DepthStrip<float>& strip, const ColumnSums& sums) {
  sumColumns(strip, sums);
}
void sumColumnsU16(const DepthStrip<std::uint16_t>& strip, const ColumnSums& sums) {
  sumColumns(strip, sums);
}

/// Sums of groups of four neighbouring columns, one group a lane.
template <class D>
hn::Vec<D> sumOfFours(D d, const float* columns) {
  hn::Vec<D> a, b, c, e;
  hn::LoadInterleaved4(d, columns, a, b, c, e);
  return hn::Add(hn::Add(a, b), hn::Add(c, e));
}

void sumCells(const ColumnSums& columns, int cell_width, int cells, DepthSums* sums,
              float* counts) {
  const hn::ScalableTag<float> d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  int cell = 0;
  if (cell_width == 4) {
    for (; cell + lanes <= cells; cell += lanes) {
      const int x = 4 * cell;
      hn::StoreU(sumOfFours(d, columns.n + x), d, counts + cell);
      hn::StoreInterleaved4(sumOfFours(d, columns.q + x), sumOfFours(d, columns.qu + x),
                            sumOfFours(d, columns.qv + x), sumOfFours(d, columns.qq + x), d,
                            &sums[cell].q);
    }
  }
  scalar::sumCells(columns, cell_width, cell, cells, sums, counts);
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

/// How many of the nodes were regressed: whole vectors.
std::size_t regressVectors(const DepthSums* sums, const FullNodeRows& nodes, std::size_t count,
                           NodePlane* planes) {
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
                          &planes[i].alpha);
  }
  return i;
}
#else
std::size_t regressVectors(const DepthSums*, const FullNodeRows&, std::size_t, NodePlane*) {
  return 0;
}
#endif

void regress(const DepthSums* sums, const FullNodeRows& nodes, std::size_t count,
             NodePlane* planes) {
  scalar::regress(sums, nodes, regressVectors(sums, nodes, count, planes), count, planes);
}

void weigh(const NodeRows& nodes, const DistortionRule& rule, std::size_t count,
           float* distortions) {
  const hn::ScalableTag<float> d;
  const std::size_t lanes = hn::Lanes(d);
  const auto one = hn::Set(d, 1.0F);
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes) {
    hn::Vec<decltype(d)> alpha, beta, gamma, rms, q, qu, qv, qq;
    hn::LoadInterleaved4(d, &nodes.planes[i].alpha, alpha, beta, gamma, rms);
    hn::LoadInterleaved4(d, &nodes.sums[i].q, q, qu, qv, qq);
    const auto n = hn::LoadU(d, nodes.counts + i);
    const auto front = hn::Eq(hn::CopySign(one, rms), one);
    const auto known =
        hn::And(front, hn::And(hn::Gt(n, hn::Zero(d)), hn::Eq(n, hn::LoadU(d, nodes.full + i))));
    const auto depth = hn::Div(n, hn::IfThenElse(known, q, one));
    auto scale = hn::Mul(hn::Set(d, rule.factor), n);
    for (int power = 0; power < rule.depth_power; ++power) scale = hn::Mul(scale, depth);
    hn::StoreU(hn::IfThenElse(known, hn::Mul(scale, rms), hn::Set(d, -1.0F)), d, distortions + i);
  }
  scalar::weigh(nodes, rule, i, count, distortions);
}

/// A row's inverse depths from pixel `x` on, `left` of them. Rows may be read past their block:
/// those lanes, like pixels without depth, are 0.
template <bool kFills, class D>
hn::Vec<D> loadPixels(D d, const float* row, int left) {
  const auto q = hn::LoadU(d, row);
  if constexpr (kFills) return q;
  return hn::IfThenElseZero(hn::FirstN(d, static_cast<std::size_t>(left)), q);
}

/// `kFills`: rows are whole vectors long.
template <bool kFills, class D>
TangentSums sumTangentsBy(D d, const PixelBlock& pixels) {
  const int lanes = static_cast<int>(hn::Lanes(d));
  const auto zero = hn::Zero(d);
  auto sum_u = zero, sum_v = zero, sum_uu = zero, sum_uv = zero, sum_vv = zero;
  for (int y = 0; y < pixels.rows; ++y) {
    for (int x = 0; x < pixels.width; x += lanes) {
      const std::ptrdiff_t at = y * pixels.tangents.stride + x;
      const auto q = loadPixels<kFills>(d, pixels.inverse_depth + at, pixels.width - x);
      const auto valid = hn::Gt(q, zero);
      const auto u = hn::IfThenElseZero(valid, hn::LoadU(d, pixels.tangents.u + at));
      const auto v = hn::IfThenElseZero(valid, hn::LoadU(d, pixels.tangents.v + at));
      sum_u = hn::Add(sum_u, u);
      sum_v = hn::Add(sum_v, v);
      sum_uu = hn::MulAdd(u, u, sum_uu);
      sum_uv = hn::MulAdd(u, v, sum_uv);
      sum_vv = hn::MulAdd(v, v, sum_vv);
    }
  }
  const auto sum = [&](auto values) { return hn::GetLane(hn::SumOfLanes(d, values)); };
  return {sum(sum_u), sum(sum_v), sum(sum_uu), sum(sum_uv), sum(sum_vv)};
}

template <class D>
TangentSums sumTangentsWith(D d, const PixelBlock& pixels) {
  const bool fills = pixels.width % static_cast<int>(hn::Lanes(d)) == 0;
  return fills ? sumTangentsBy<true>(d, pixels) : sumTangentsBy<false>(d, pixels);
}

TangentSums sumTangents(const PixelBlock& pixels) {
  if (pixels.width <= 4) return sumTangentsWith(hn::CappedTag<float, 4>(), pixels);
  return sumTangentsWith(hn::CappedTag<float, 8>(), pixels);
}

/// `kFills`: rows are whole vectors long.
template <bool kFills, class D>
ResidualSums residualsBy(D d, const ResidualQuery& query) {
  const int lanes = static_cast<int>(hn::Lanes(d));
  const auto alpha = hn::Set(d, query.alpha);
  const auto beta = hn::Set(d, query.beta);
  const auto gamma = hn::Set(d, query.gamma);
  const auto zero = hn::Zero(d);
  auto inverse_depth = zero, relative = zero, depth = zero;
  const PixelBlock& pixels = query.pixels;
  for (int y = 0; y < pixels.rows; ++y) {
    for (int x = 0; x < pixels.width; x += lanes) {
      const std::ptrdiff_t at = y * pixels.tangents.stride + x;
      const auto q = loadPixels<kFills>(d, pixels.inverse_depth + at, pixels.width - x);
      const auto u = hn::LoadU(d, pixels.tangents.u + at);
      const auto v = hn::LoadU(d, pixels.tangents.v + at);
      const auto plane = hn::MulAdd(alpha, u, hn::MulAdd(beta, v, gamma));
      const auto valid = hn::Gt(q, zero);
      const auto error = hn::IfThenElseZero(valid, hn::Abs(hn::Sub(q, plane)));
      const auto product = hn::IfThenElse(valid, hn::Abs(hn::Mul(q, plane)), hn::Set(d, 1.0F));
      const auto depth_error = hn::Div(error, product);
      inverse_depth = hn::Add(inverse_depth, error);
      relative = hn::MulAdd(depth_error, hn::Abs(plane), relative);
      depth = hn::Add(depth, depth_error);
    }
  }
  ResidualSums sums;
  sums.inverse_depth = hn::GetLane(hn::SumOfLanes(d, inverse_depth));
  sums.relative = hn::GetLane(hn::SumOfLanes(d, relative));
  sums.depth = hn::GetLane(hn::SumOfLanes(d, depth));
  return sums;
}

template <class D>
ResidualSums residualsWith(D d, const ResidualQuery& query) {
  const bool fills = query.pixels.width % static_cast<int>(hn::Lanes(d)) == 0;
  return fills ? residualsBy<true>(d, query) : residualsBy<false>(d, query);
}

ResidualSums residuals(const ResidualQuery& query) {
  if (query.pixels.width <= 4) return residualsWith(hn::CappedTag<float, 4>(), query);
  if (query.pixels.width <= 8) return residualsWith(hn::CappedTag<float, 8>(), query);
  return residualsWith(hn::CappedTag<float, 16>(), query);
}

const char* targetName() { return hwy::TargetName(HWY_TARGET); }

}  // namespace planecloud::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace planecloud {

HWY_EXPORT(sumColumnsF32);
HWY_EXPORT(sumColumnsU16);
HWY_EXPORT(sumCells);
HWY_EXPORT(sumTangents);
HWY_EXPORT(regress);
HWY_EXPORT(weigh);
HWY_EXPORT(residuals);
HWY_EXPORT(targetName);

const TileKernels& vectorTileKernels() {
  static const TileKernels kernels = [] {
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    return TileKernels{HWY_DYNAMIC_DISPATCH(targetName)(),   &HWY_DYNAMIC_DISPATCH(sumColumnsF32),
                       &HWY_DYNAMIC_DISPATCH(sumColumnsU16), &HWY_DYNAMIC_DISPATCH(sumCells),
                       &HWY_DYNAMIC_DISPATCH(sumTangents),   &HWY_DYNAMIC_DISPATCH(regress),
                       &HWY_DYNAMIC_DISPATCH(weigh),         &HWY_DYNAMIC_DISPATCH(residuals)};
  }();
  return kernels;
}

}  // namespace planecloud
#endif  // HWY_ONCE

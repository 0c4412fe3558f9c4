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

/// `kFills`: rows are whole vectors long.
template <bool kFills, class D>
ResidualSums residualsBy(D d, const ResidualQuery& query) {
  const int lanes = static_cast<int>(hn::Lanes(d));
  const auto alpha = hn::Set(d, query.alpha);
  const auto beta = hn::Set(d, query.beta);
  const auto gamma = hn::Set(d, query.gamma);
  const auto zero = hn::Zero(d);
  auto inverse_depth = zero, relative = zero, depth = zero;
  for (int y = 0; y < query.rows; ++y) {
    for (int x = 0; x < query.width; x += lanes) {
      const std::ptrdiff_t at = y * query.tangents.stride + x;
      auto q = hn::LoadU(d, query.inverse_depth + at);
      if constexpr (!kFills) {
        // Rows may be read past the tile: those lanes, like pixels without depth, add nothing.
        q = hn::IfThenElseZero(hn::FirstN(d, static_cast<std::size_t>(query.width - x)), q);
      }
      const auto u = hn::LoadU(d, query.tangents.u + at);
      const auto v = hn::LoadU(d, query.tangents.v + at);
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
  const bool fills = query.width % static_cast<int>(hn::Lanes(d)) == 0;
  return fills ? residualsBy<true>(d, query) : residualsBy<false>(d, query);
}

ResidualSums residuals(const ResidualQuery& query) {
  if (query.width <= 4) return residualsWith(hn::CappedTag<float, 4>(), query);
  if (query.width <= 8) return residualsWith(hn::CappedTag<float, 8>(), query);
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
HWY_EXPORT(residuals);
HWY_EXPORT(targetName);

const TileKernels& vectorTileKernels() {
  static const TileKernels kernels = [] {
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    return TileKernels{HWY_DYNAMIC_DISPATCH(targetName)(), &HWY_DYNAMIC_DISPATCH(sumColumnsF32),
                       &HWY_DYNAMIC_DISPATCH(sumColumnsU16), &HWY_DYNAMIC_DISPATCH(sumCells),
                       &HWY_DYNAMIC_DISPATCH(residuals)};
  }();
  return kernels;
}

}  // namespace planecloud
#endif  // HWY_ONCE

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/plane_fit/tile_kernels_scalar.h"
#include "planecloud_slam/plane_fit/tile_kernels_simd.h"

// Compiled once for every instruction set that Highway knows here, chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "planecloud_slam/plane_fit/tile_pixels_simd.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace planecloud::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Depth [m] of a vector of pixels, 0 where there is none (see DepthTraits).
template <class D>
hn::Vec<D> loadDepth(D d, const float* depth) {
  const hn::Vec<D> z = hn::LoadU(d, depth);
  const auto valid = hn::And(hn::Ge(z, hn::Set(d, kMinDepth)), hn::Le(z, hn::Set(d, kMaxDepth)));
  return hn::IfThenElseZero(valid, z);
}

/// Depth [mm].
template <class D>
hn::Vec<D> loadMillimetres(D d, const std::uint16_t* depth) {
  const hn::Rebind<std::uint16_t, D> du16;
  const hn::Rebind<std::int32_t, D> di32;
  const hn::Vec<D> z = hn::ConvertTo(d, hn::PromoteTo(di32, hn::LoadU(du16, depth)));
  return hn::IfThenElseZero(hn::Ge(z, hn::Set(d, kMinDepth * 1000.0F)), z);
}

template <class D>
hn::Vec<D> loadDepth(D d, const std::uint16_t* depth) {
  return hn::Mul(loadMillimetres(d, depth), hn::Set(d, 0.001F));
}

/// Inverse depth [1/m], 0 where there is none.
template <class D>
hn::Vec<D> invert(D d, hn::Vec<D> depth, float unit) {
  const auto valid = hn::Gt(depth, hn::Zero(d));
  return hn::IfThenElseZero(valid, hn::Div(hn::Set(d, unit), depth));
}

template <class D>
hn::Vec<D> loadInverse(D d, const float* depth) {
  return invert(d, loadDepth(d, depth), 1.0F);
}

template <class D>
hn::Vec<D> loadInverse(D d, const std::uint16_t* depth) {
  return invert(d, loadMillimetres(d, depth), 1000.0F);
}

template <typename Pixel>
void sumColumns(const DepthBlock<Pixel>& strip, const ColumnSums& sums) {
  const hn::ScalableTag<float> d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const auto zero = hn::Zero(d);
  const auto one = hn::Set(d, 1.0F);
  int x = 0;
  for (; x + lanes <= strip.width; x += lanes) {
    auto n = zero, q = zero, qy = zero, qq = zero, row = zero;
    for (int y = 0; y < strip.rows; ++y) {
      const Pixel* pixels = strip.depth + y * strip.stride + x;
      hwy::Prefetch(pixels + strip.rows * strip.stride);  // the next strip's
      const auto value = loadInverse(d, pixels);
      n = hn::Add(n, hn::IfThenElseZero(hn::Gt(value, zero), one));
      q = hn::Add(q, value);
      qy = hn::MulAdd(value, row, qy);
      qq = hn::MulAdd(value, value, qq);
      row = hn::Add(row, one);
    }
    hn::StoreU(n, d, sums.n + x);
    hn::StoreU(q, d, sums.q + x);
    hn::StoreU(qy, d, sums.qy + x);
    hn::StoreU(qq, d, sums.qq + x);
  }
  scalar::sumColumns(strip, sums, x);
}

/// Bit 0 and 1: some column of the left and of the right half is above zero.
template <class D>
unsigned halvesAbove(D d, hn::Vec<D> columns) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(d, hn::Gt(columns, hn::Zero(d)), bytes);
  const unsigned half = static_cast<unsigned>(hn::Lanes(d)) / 2;
  const unsigned left = bytes[0] & ((1U << half) - 1U);
  return (left != 0 ? 1U : 0U) | (bytes[0] >> half != 0 ? 2U : 0U);
}

/// Of a block as wide as the vector.
template <class D, typename Pixel>
PositionSums sumPositionsBy(D d, const DepthBlock<Pixel>& block) {
  const auto zero = hn::Zero(d);
  const auto one = hn::Set(d, 1.0F);
  auto n = zero, upper = zero, y1 = zero, y2 = zero, row = zero;
  for (int y = 0; y < block.rows; ++y) {
    if (2 * y == block.rows || 2 * y == block.rows + 1) upper = n;
    const auto valid = hn::Gt(loadDepth(d, block.depth + y * block.stride), zero);
    n = hn::Add(n, hn::IfThenElseZero(valid, one));
    y1 = hn::Add(y1, hn::IfThenElseZero(valid, row));
    y2 = hn::Add(y2, hn::IfThenElseZero(valid, hn::Mul(row, row)));
    row = hn::Add(row, one);
  }
  const auto x = hn::Iota(d, 0.0F);
  const auto sum = [&](auto values) { return hn::GetLane(hn::SumOfLanes(d, values)); };
  if (block.rows < 2) upper = n;
  const unsigned quarters = halvesAbove(d, upper) | halvesAbove(d, hn::Sub(n, upper)) << 2U;
  return {sum(n),
          sum(hn::Mul(n, x)),
          sum(y1),
          sum(hn::Mul(n, hn::Mul(x, x))),
          sum(hn::Mul(y1, x)),
          sum(y2),
          static_cast<std::uint8_t>(quarters)};
}

template <typename Pixel>
PositionSums sumPositions(const DepthBlock<Pixel>& block) {
  const hn::CappedTag<float, 4> d4;
  const hn::CappedTag<float, 8> d8;
  if (hn::Lanes(d4) == 4 && block.width == 4) return sumPositionsBy(d4, block);
  if (hn::Lanes(d8) == 8 && block.width == 8) return sumPositionsBy(d8, block);
  return scalar::sumPositions(block);
}

template <class D, typename Pixel>
BlockSums sumBlockBy(D d, const DepthBlock<Pixel>& block, const TangentRows& tangents) {
  const int lanes = static_cast<int>(hn::Lanes(d));
  const auto zero = hn::Zero(d);
  auto sum_u = zero, sum_v = zero, sum_uu = zero, sum_uv = zero, sum_vv = zero;
  auto sum_qu = zero, sum_qv = zero;
  const int whole = block.width - block.width % lanes;
  for (int y = 0; y < block.rows; ++y) {
    for (int x = 0; x < whole; x += lanes) {
      const std::ptrdiff_t at = y * tangents.stride + x;
      const auto q = loadInverse(d, block.depth + y * block.stride + x);
      const auto valid = hn::Gt(q, zero);
      const auto u = hn::IfThenElseZero(valid, hn::LoadU(d, tangents.u + at));
      const auto v = hn::IfThenElseZero(valid, hn::LoadU(d, tangents.v + at));
      sum_u = hn::Add(sum_u, u);
      sum_v = hn::Add(sum_v, v);
      sum_uu = hn::MulAdd(u, u, sum_uu);
      sum_uv = hn::MulAdd(u, v, sum_uv);
      sum_vv = hn::MulAdd(v, v, sum_vv);
      sum_qu = hn::MulAdd(q, u, sum_qu);
      sum_qv = hn::MulAdd(q, v, sum_qv);
    }
  }
  const auto sum = [&](auto values) { return hn::GetLane(hn::SumOfLanes(d, values)); };
  BlockSums sums{
      {sum(sum_u), sum(sum_v), sum(sum_uu), sum(sum_uv), sum(sum_vv)}, sum(sum_qu), sum(sum_qv)};
  if (whole < block.width) sums += scalar::sumBlock(block, tangents, whole);
  return sums;
}

template <typename Pixel>
BlockSums sumBlock(const DepthBlock<Pixel>& block, const TangentRows& tangents) {
  if (block.width < 8) return sumBlockBy(hn::CappedTag<float, 4>(), block, tangents);
  return sumBlockBy(hn::CappedTag<float, 8>(), block, tangents);
}

template <class D, typename Pixel>
ResidualSums residualsBy(D d, const DepthBlock<Pixel>& block, const TangentRows& tangents,
                         const NodePlane& plane) {
  const int lanes = static_cast<int>(hn::Lanes(d));
  const auto alpha = hn::Set(d, plane.alpha);
  const auto beta = hn::Set(d, plane.beta);
  const auto gamma = hn::Set(d, plane.gamma);
  const auto zero = hn::Zero(d);
  const auto one = hn::Set(d, 1.0F);
  auto inverse_depth = zero, relative = zero, depth = zero;
  const int whole = block.width - block.width % lanes;
  for (int y = 0; y < block.rows; ++y) {
    for (int x = 0; x < whole; x += lanes) {
      const std::ptrdiff_t at = y * tangents.stride + x;
      const auto z = loadDepth(d, block.depth + y * block.stride + x);
      const auto valid = hn::Gt(z, zero);
      const auto u = hn::LoadU(d, tangents.u + at);
      const auto v = hn::LoadU(d, tangents.v + at);
      const auto q = hn::MulAdd(alpha, u, hn::MulAdd(beta, v, gamma));
      const auto error = hn::IfThenElseZero(valid, hn::Abs(hn::NegMulAdd(q, z, one)));
      inverse_depth = hn::Add(inverse_depth, hn::Div(error, hn::IfThenElse(valid, z, one)));
      relative = hn::Add(relative, error);
      depth = hn::Add(depth, hn::Div(error, hn::IfThenElse(valid, hn::Abs(q), one)));
    }
  }
  const auto sum = [&](auto values) { return hn::GetLane(hn::SumOfLanes(d, values)); };
  ResidualSums sums{sum(inverse_depth), sum(relative), sum(depth)};
  if (whole < block.width) sums += scalar::residuals(block, tangents, plane, whole);
  return sums;
}

template <typename Pixel>
ResidualSums residuals(const DepthBlock<Pixel>& block, const TangentRows& tangents,
                       const NodePlane& plane) {
  if (block.width < 8) return residualsBy(hn::CappedTag<float, 4>(), block, tangents, plane);
  if (block.width < 16) return residualsBy(hn::CappedTag<float, 8>(), block, tangents, plane);
  return residualsBy(hn::CappedTag<float, 16>(), block, tangents, plane);
}

template <typename Pixel>
PixelKernels<Pixel> pixelKernels() {
  return {&sumColumns<Pixel>, &sumPositions<Pixel>, &sumBlock<Pixel>, &residuals<Pixel>};
}

void addPixelKernels(TileKernels& kernels) {
  kernels.f32 = pixelKernels<float>();
  kernels.u16 = pixelKernels<std::uint16_t>();
}

}  // namespace planecloud::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace planecloud {

HWY_EXPORT(addPixelKernels);

void addVectorPixelKernels(TileKernels& kernels) { HWY_DYNAMIC_DISPATCH(addPixelKernels)(kernels); }

}  // namespace planecloud
#endif  // HWY_ONCE

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstring>

#include "planecloud_slam/frontend_node/remap_kernel_scalar.h"

// Compiled once for every instruction set that Highway knows here, chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "planecloud_slam/frontend_node/remap_kernel_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace planecloud::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using RemapD = hn::CappedTag<float, 8>;
using RemapDI = hn::RebindToSigned<RemapD>;
using RemapV = hn::Vec<RemapD>;

HWY_INLINE RemapV toFloat(const std::uint8_t* values) {
  const hn::Rebind<std::uint8_t, RemapD> bytes;
  return hn::ConvertTo(RemapD(), hn::PromoteTo(RemapDI(), hn::LoadU(bytes, values)));
}

/// Pairs of neighbouring grey values of a row, blended. Whole numbers: nothing is rounded.
HWY_INLINE RemapV blend(const std::uint16_t* pairs, RemapV right) {
  const RemapD d;
  const RemapDI di;
  const hn::Rebind<std::uint16_t, RemapD> words;
  const auto pair = hn::PromoteTo(di, hn::Load(words, pairs));
  const RemapV first = hn::ConvertTo(d, hn::And(pair, hn::Set(di, 255)));
  const RemapV second = hn::ConvertTo(d, hn::ShiftRight<8>(pair));
  return hn::MulAdd(right, hn::Sub(second, first),
                    hn::Mul(hn::Set(d, static_cast<float>(kRemapSteps)), first));
}

void remap(const RemapSource& source, const RemapRow& row, std::size_t count, std::uint8_t* grey,
           float* depth) {
  const RemapD d;
  const RemapDI di;
  const hn::Rebind<std::uint8_t, RemapD> bytes;
  const std::size_t lanes = hn::Lanes(d);
  const RemapV steps = hn::Set(d, static_cast<float>(kRemapSteps));
  const RemapV half = hn::Set(d, 0.5F * static_cast<float>(kRemapSteps));
  const RemapV unit = hn::Set(d, 1.0F / static_cast<float>(kRemapSteps * kRemapSteps));
  const RemapV rounding = hn::Set(d, 0.5F);
  const RemapV none = hn::Set(d, std::numeric_limits<float>::quiet_NaN());
  HWY_ALIGN std::int32_t at[8];
  HWY_ALIGN std::int32_t nearest[8];
  HWY_ALIGN std::uint16_t upper[8];
  HWY_ALIGN std::uint16_t lower[8];
  HWY_ALIGN float near_depth[8];
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes) {
    const auto coded = hn::LoadU(di, row.at + i);
    const auto index = hn::Xor(coded, hn::ShiftRight<31>(coded));
    const RemapV right = toFloat(row.right + i), down = toFloat(row.down + i);
    const auto to_right =
        hn::IfThenElseZero(hn::RebindMask(di, hn::Gt(right, half)), hn::Set(di, 1));
    const auto to_lower =
        hn::IfThenElseZero(hn::RebindMask(di, hn::Gt(down, half)), hn::Set(di, source.width));
    hn::Store(index, di, at);
    hn::Store(hn::Add(index, hn::Add(to_right, to_lower)), di, nearest);
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      std::memcpy(upper + lane, source.grey + at[lane], 2);
      std::memcpy(lower + lane, source.grey + at[lane] + source.width, 2);
      near_depth[lane] = source.depth[nearest[lane]];
    }
    const RemapV top = blend(upper, right);
    const RemapV bottom = blend(lower, right);
    const RemapV sum = hn::MulAdd(down, hn::Sub(bottom, top), hn::Mul(steps, top));
    const auto rounded = hn::ConvertTo(di, hn::MulAdd(sum, unit, rounding));
    hn::StoreU(hn::DemoteTo(bytes, rounded), bytes, grey + i);
    const auto is_outside = hn::RebindMask(d, hn::Lt(coded, hn::Zero(di)));
    hn::StoreU(hn::IfThenElse(is_outside, none, hn::Load(d, near_depth)), d, depth + i);
  }
  scalar::remap(source, row, i, count, grey, depth);
}

}  // namespace planecloud::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace planecloud {

HWY_EXPORT(remap);

RemapKernel vectorRemap() {
  static const RemapKernel kernel = [] {
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    return &HWY_DYNAMIC_DISPATCH(remap);
  }();
  return kernel;
}

}  // namespace planecloud
#endif  // HWY_ONCE

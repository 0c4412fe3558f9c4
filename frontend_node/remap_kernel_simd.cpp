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

using RemapVI = hn::Vec<RemapDI>;

/// See scalar::remapPlace.
struct RemapPlaces {
  RemapVI pixel, part;
  hn::Mask<RemapDI> is_inside;
};

HWY_INLINE RemapPlaces remapPlaces(RemapVI at, std::int32_t pixels) {
  const RemapDI di;
  constexpr int kDropped = kRemapBits - kRemapStepBits;
  const auto inside = hn::Max(hn::Min(at, hn::Set(di, (pixels - 1) * kRemapUnit)), hn::Zero(di));
  const auto pixel = hn::Min(hn::ShiftRight<kRemapBits>(inside), hn::Set(di, pixels - 2));
  const auto rest = hn::Sub(inside, hn::ShiftLeft<kRemapBits>(pixel));
  const auto part = hn::ShiftRight<kDropped>(hn::Add(rest, hn::Set(di, 1 << (kDropped - 1))));
  const auto beyond = hn::Abs(hn::Sub(at, inside));
  return {pixel, part, hn::Lt(beyond, hn::Set(di, kRemapUnit / 2 + 1))};
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

void remap(const RemapSource& source, const RemapSpan* spans, std::size_t count, std::uint8_t* grey,
           float* depth) {
  const RemapD d;
  const RemapDI di;
  const hn::Rebind<std::uint8_t, RemapD> bytes;
  const std::size_t lanes = hn::Lanes(d);
  const RemapV steps = hn::Set(d, static_cast<float>(kRemapSteps));
  const RemapV unit = hn::Set(d, 1.0F / static_cast<float>(kRemapSteps * kRemapSteps));
  const RemapV rounding = hn::Set(d, 0.5F);
  const RemapV none = hn::Set(d, std::numeric_limits<float>::quiet_NaN());
  const auto half = hn::Set(di, kRemapSteps / 2);
  HWY_ALIGN std::int32_t at[8];
  HWY_ALIGN std::int32_t nearest[8];
  HWY_ALIGN std::uint16_t upper[8];
  HWY_ALIGN std::uint16_t lower[8];
  HWY_ALIGN float near_depth[8];
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes) {
    const RemapSpan& span = spans[i / kRemapSpan];
    const auto k = hn::Iota(di, static_cast<std::int32_t>(i % kRemapSpan));
    const auto along = [&](std::int32_t first, std::int32_t step) {
      return hn::Add(hn::Set(di, first), hn::Mul(k, hn::Set(di, step)));
    };
    const RemapPlaces x = remapPlaces(along(span.x, span.step_x), source.width);
    const RemapPlaces y = remapPlaces(along(span.y, span.step_y), source.height);
    const auto width = hn::Set(di, source.width);
    const auto index = hn::Add(hn::Mul(y.pixel, width), x.pixel);
    const auto to_right = hn::IfThenElseZero(hn::Gt(x.part, half), hn::Set(di, 1));
    const auto to_lower = hn::IfThenElseZero(hn::Gt(y.part, half), width);
    hn::Store(index, di, at);
    hn::Store(hn::Add(index, hn::Add(to_right, to_lower)), di, nearest);
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      std::memcpy(upper + lane, source.grey + at[lane], 2);
      std::memcpy(lower + lane, source.grey + at[lane] + source.width, 2);
      near_depth[lane] = source.depth[nearest[lane]];
    }
    const RemapV right = hn::ConvertTo(d, x.part), down = hn::ConvertTo(d, y.part);
    const RemapV top = blend(upper, right);
    const RemapV bottom = blend(lower, right);
    const RemapV sum = hn::MulAdd(down, hn::Sub(bottom, top), hn::Mul(steps, top));
    const auto rounded = hn::ConvertTo(di, hn::MulAdd(sum, unit, rounding));
    hn::StoreU(hn::DemoteTo(bytes, rounded), bytes, grey + i);
    const auto is_inside = hn::RebindMask(d, hn::And(x.is_inside, y.is_inside));
    hn::StoreU(hn::IfThenElse(is_inside, hn::Load(d, near_depth), none), d, depth + i);
  }
  scalar::remap(source, spans, i, count, grey, depth);
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

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstring>

#include "planecloud_slam/frontend_node/half_remap_kernel_scalar.h"

// Compiled once for every instruction set that Highway knows here, chosen at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "planecloud_slam/frontend_node/half_remap_kernel_simd.cpp"
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

/// Weighted sum of three values. Whole numbers below 2^24: nothing is rounded.
HWY_INLINE RemapV sumOfThree(RemapV a, RemapV b, RemapV c, RemapV fraction) {
  const RemapV steps = hn::Set(RemapD(), static_cast<float>(kHalfRemapSteps));
  return hn::MulAdd(fraction, hn::Sub(c, a), hn::Mul(steps, hn::Add(a, b)));
}

/// The same of the first three bytes of each word.
HWY_INLINE RemapV sumOfTaps(const std::uint32_t* words, RemapV right) {
  const RemapD d;
  const hn::RebindToUnsigned<RemapD> du;
  const RemapDI di;
  const auto word = hn::Load(du, words);
  const auto byte = [&](auto shifted) {
    return hn::ConvertTo(d, hn::BitCast(di, hn::And(shifted, hn::Set(du, 255U))));
  };
  return sumOfThree(byte(word), byte(hn::ShiftRight<8>(word)), byte(hn::ShiftRight<16>(word)),
                    right);
}

void halfRemap(const GreySource& source, const HalfRemapRow& row, std::size_t count, float* grey) {
  const RemapD d;
  const std::size_t lanes = hn::Lanes(d);
  HWY_ALIGN std::uint32_t words[3][8];
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes) {
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const std::uint8_t* taps = source.pixels + row.at[i + lane];
      std::memcpy(words[0] + lane, taps, 4);
      std::memcpy(words[1] + lane, taps + source.width, 4);
      std::memcpy(words[2] + lane, taps + 2 * source.width, 4);
    }
    const RemapV right = toFloat(row.right + i);
    const RemapV sum = sumOfThree(sumOfTaps(words[0], right), sumOfTaps(words[1], right),
                                  sumOfTaps(words[2], right), toFloat(row.down + i));
    hn::StoreU(hn::Mul(sum, hn::Set(d, scalar::kHalfRemapUnit)), d, grey + i);
  }
  scalar::halfRemap(source, row, i, count, grey);
}

}  // namespace planecloud::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace planecloud {

HWY_EXPORT(halfRemap);

HalfRemapKernel vectorHalfRemap() {
  static const HalfRemapKernel kernel = [] {
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    return &HWY_DYNAMIC_DISPATCH(halfRemap);
  }();
  return kernel;
}

}  // namespace planecloud
#endif  // HWY_ONCE

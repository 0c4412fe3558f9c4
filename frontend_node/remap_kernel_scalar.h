// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdlib>
#include <limits>

#include "planecloud_slam/frontend_node/remap_kernel.h"

/// The scalar loop, which the vector kernel also uses for what a vector does not fill.
namespace planecloud::scalar {

/// Along one axis: the first of the two pixels around, and how far behind it [1 / kRemapSteps px].
struct RemapPlace {
  std::int32_t pixel = 0;
  std::int32_t part = 0;
  bool is_inside = false;
};

/// Of the coordinate `at` in an image of so many pixels.
inline RemapPlace remapPlace(std::int32_t at, std::int32_t pixels) {
  const std::int32_t inside = std::clamp(at, 0, (pixels - 1) * kRemapUnit);
  const std::int32_t pixel = std::min(inside >> kRemapBits, pixels - 2);
  constexpr int kDropped = kRemapBits - kRemapStepBits;
  const std::int32_t part = (inside - pixel * kRemapUnit + (1 << (kDropped - 1))) >> kDropped;
  return {pixel, part, std::abs(at - inside) <= kRemapUnit / 2};
}

/// Pixels [first, count).
inline void remap(const RemapSource& source, const RemapSpan* spans, std::size_t first,
                  std::size_t count, std::uint8_t* grey, float* depth) {
  for (std::size_t i = first; i < count; ++i) {
    const RemapSpan& span = spans[i / kRemapSpan];
    const auto steps = static_cast<std::int32_t>(i % kRemapSpan);
    const RemapPlace x = remapPlace(span.x + steps * span.step_x, source.width);
    const RemapPlace y = remapPlace(span.y + steps * span.step_y, source.height);
    const int at = y.pixel * source.width + x.pixel;
    const std::uint8_t* upper = source.grey + at;
    const std::uint8_t* lower = upper + source.width;
    const int top = kRemapSteps * upper[0] + x.part * (upper[1] - upper[0]);
    const int bottom = kRemapSteps * lower[0] + x.part * (lower[1] - lower[0]);
    constexpr int kSquare = kRemapSteps * kRemapSteps;
    grey[i] = static_cast<std::uint8_t>(
        (kRemapSteps * top + y.part * (bottom - top) + kSquare / 2) / kSquare);
    const int nearest =
        at + (2 * x.part > kRemapSteps ? 1 : 0) + (2 * y.part > kRemapSteps ? source.width : 0);
    depth[i] = x.is_inside && y.is_inside ? source.depth[nearest]
                                          : std::numeric_limits<float>::quiet_NaN();
  }
}

}  // namespace planecloud::scalar

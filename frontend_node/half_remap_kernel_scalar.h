// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "planecloud_slam/frontend_node/half_remap_kernel.h"

/// The scalar loop, which the vector kernel also uses for what a vector does not fill.
namespace planecloud::scalar {

/// Of the whole numbers that are summed: weights are in steps, halved in either direction.
inline constexpr float kHalfRemapUnit =
    1.0F / static_cast<float>(4 * kHalfRemapSteps * kHalfRemapSteps);

/// Pixels [first, count).
inline void halfRemap(const GreySource& source, const HalfRemapRow& row, std::size_t first,
                      std::size_t count, float* grey) {
  for (std::size_t i = first; i < count; ++i) {
    int sums[3];
    for (int line = 0; line < 3; ++line) {
      const std::uint8_t* taps = source.pixels + row.at[i] + line * source.width;
      sums[line] = kHalfRemapSteps * (taps[0] + taps[1]) + row.right[i] * (taps[2] - taps[0]);
    }
    const int sum = kHalfRemapSteps * (sums[0] + sums[1]) + row.down[i] * (sums[2] - sums[0]);
    grey[i] = kHalfRemapUnit * static_cast<float>(sum);
  }
}

}  // namespace planecloud::scalar

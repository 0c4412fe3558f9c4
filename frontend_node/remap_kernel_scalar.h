// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>

#include "planecloud_slam/frontend_node/remap_kernel.h"

/// The scalar loop, which the vector kernel also uses for what a vector does not fill.
namespace planecloud::scalar {

/// Pixels [first, count).
inline void remap(const RemapSource& source, const RemapRow& row, std::size_t first,
                  std::size_t count, std::uint8_t* grey, float* depth) {
  for (std::size_t i = first; i < count; ++i) {
    const bool is_inside = row.at[i] >= 0;
    const std::int32_t at = is_inside ? row.at[i] : ~row.at[i];
    const int right = row.right[i];
    const int down = row.down[i];
    const std::uint8_t* upper = source.grey + at;
    const std::uint8_t* lower = upper + source.width;
    const int top = kRemapSteps * upper[0] + right * (upper[1] - upper[0]);
    const int bottom = kRemapSteps * lower[0] + right * (lower[1] - lower[0]);
    constexpr int kSquare = kRemapSteps * kRemapSteps;
    grey[i] = static_cast<std::uint8_t>((kRemapSteps * top + down * (bottom - top) + kSquare / 2) /
                                        kSquare);
    const int nearest =
        at + (2 * right > kRemapSteps ? 1 : 0) + (2 * down > kRemapSteps ? source.width : 0);
    depth[i] = is_inside ? source.depth[nearest] : std::numeric_limits<float>::quiet_NaN();
  }
}

}  // namespace planecloud::scalar

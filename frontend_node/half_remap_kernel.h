// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

/// The inner loop that undistorts a grey image and halves it in one step.
namespace planecloud {

/// Steps between neighbouring pixels in which positions are kept.
inline constexpr int kHalfRemapSteps = 32;

/// Where pixels of half the resolution come from, an array for each. The mean over 2x2 pixels, each
/// sampled bilinearly, is a sum over 3x3 pixels with the weights (1 - f, 1, f) / 2 in either
/// direction.
struct HalfRemapRow {
  /// Index of the upper left of them. In each of the three rows a fourth pixel is read to the
  /// right.
  const std::int32_t* at = nullptr;
  const std::uint8_t* right = nullptr;  ///< f along the row [1 / kHalfRemapSteps], [0, all of them]
  const std::uint8_t* down = nullptr;   ///< f across the rows, likewise
};

/// A grey image whose rows follow each other without gaps.
struct GreySource {
  const std::uint8_t* pixels = nullptr;
  int width = 0;
};

/// Makes `count` grey values [0, 255].
using HalfRemapKernel = void (*)(const GreySource& source, const HalfRemapRow& row,
                                 std::size_t count, float* grey);

/// Two implementations that give the same bits; the vector one is that for the best instruction
/// set this processor has, the scalar one when built without Highway.
[[nodiscard]] HalfRemapKernel scalarHalfRemap();
[[nodiscard]] HalfRemapKernel vectorHalfRemap();

}  // namespace planecloud

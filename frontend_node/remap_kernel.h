// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

/// The inner loop of rectification.
namespace planecloud {

/// Where up to `kRemapSpan` neighbouring pixels of a row come from in an image: the first at
/// (x, y), each next one a step farther. Over so few pixels a lens is as good as affine.
struct RemapSpan {
  std::int32_t x = 0, y = 0;            ///< [1 / kRemapUnit px]
  std::int32_t step_x = 0, step_y = 0;  ///< [1 / kRemapUnit px]
};
inline constexpr int kRemapSpan = 8;
inline constexpr int kRemapBits = 16;
inline constexpr int kRemapUnit = 1 << kRemapBits;
/// Parts of a pixel to which grey values are interpolated.
inline constexpr int kRemapStepBits = 5;
inline constexpr int kRemapSteps = 1 << kRemapStepBits;

/// An image pair whose rows follow each other without gaps, at least 2x2 pixels.
struct RemapSource {
  const std::uint8_t* grey = nullptr;
  const float* depth = nullptr;
  int width = 0;
  int height = 0;
};

/// Makes the `count` pixels of a row: grey bilinear, depth that of the nearest pixel. More than
/// half a pixel beyond the image depth is NaN, grey that of its border.
using RemapKernel = void (*)(const RemapSource& source, const RemapSpan* spans, std::size_t count,
                             std::uint8_t* grey, float* depth);

/// Two implementations that give the same bits; the vector one is that for the best instruction
/// set this processor has, the scalar one when built without Highway.
[[nodiscard]] RemapKernel scalarRemap();
[[nodiscard]] RemapKernel vectorRemap();

}  // namespace planecloud

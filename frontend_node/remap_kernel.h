// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

/// The inner loop of rectification.
namespace planecloud {

/// Where pixels come from in an image, an array for each.
struct RemapRow {
  /// Index of the upper left of the four pixels around, all of them in the image; its complement
  /// (~index) for a pixel beyond the image, whose nearest pixels these are.
  const std::int32_t* at = nullptr;
  const std::uint8_t* right = nullptr;  ///< of that pixel [1 / kRemapSteps px], [0, kRemapSteps]
  const std::uint8_t* down = nullptr;
};
inline constexpr int kRemapSteps = 32;

/// An image pair whose rows follow each other without gaps.
struct RemapSource {
  const std::uint8_t* grey = nullptr;
  const float* depth = nullptr;
  int width = 0;
};

/// Makes `count` pixels: grey bilinear, depth that of the nearest pixel, NaN beyond the image.
using RemapKernel = void (*)(const RemapSource& source, const RemapRow& row, std::size_t count,
                             std::uint8_t* grey, float* depth);

/// Two implementations that give the same bits; the vector one is that for the best instruction
/// set this processor has, the scalar one when built without Highway.
[[nodiscard]] RemapKernel scalarRemap();
[[nodiscard]] RemapKernel vectorRemap();

}  // namespace planecloud

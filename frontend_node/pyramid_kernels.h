// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

/// The inner loops of the image pyramid: each makes one row of pixels of two rows twice as long.
namespace planecloud {

/// Grey value and inverse depth of a pixel side by side: tracking reads both at the same place.
struct GreyDepth {
  float grey = 0.0F;           ///< 0..255
  float inverse_depth = 0.0F;  ///< [1/m]; 0: none
};

/// Depths [m] that count.
struct DepthRange {
  float least = 0.0F;
  float most = 0.0F;
};

/// Two rows of grey values.
struct GreyRows {
  const std::uint8_t* upper = nullptr;
  const std::uint8_t* lower = nullptr;
};

/// Two rows of depths [m, NaN: none], and the grey values of the row that is made of them.
struct DepthRows {
  const float* upper = nullptr;
  const float* lower = nullptr;
  const float* made_grey = nullptr;
};

/// Two implementations that give the same bits. `count`: pixels of the row that is made.
struct PyramidKernels {
  const char* name;
  void (*halve_grey)(const GreyRows& rows, int count, float* made);
  void (*halve_depth)(const DepthRows& rows, const DepthRange& range, int count, GreyDepth* made);
  void (*halve_level)(const GreyDepth* upper, const GreyDepth* lower, int count, GreyDepth* made);
};

[[nodiscard]] const PyramidKernels& scalarPyramidKernels();
/// The best this processor has; the scalar ones when built without Highway.
[[nodiscard]] const PyramidKernels& vectorPyramidKernels();

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace planecloud {

/// A colour pixel as in a `rgb8` image: three bytes, no padding.
struct Rgb8 {
  std::uint8_t r = 0;
  std::uint8_t g = 0;
  std::uint8_t b = 0;
};
static_assert(sizeof(Rgb8) == 3, "rows of Rgb8 are rows of a rgb8 image");

}  // namespace planecloud

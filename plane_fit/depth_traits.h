// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace planecloud {

/// Depths outside this range [m] are taken for missing.
inline constexpr float kMinDepth = 0.05F;
inline constexpr float kMaxDepth = 1e3F;

/// Whether a depth [m] was measured.
[[nodiscard]] inline bool hasDepth(float depth) { return depth >= kMinDepth && depth <= kMaxDepth; }

/// How a pixel of a depth image is read (REP 118).
template <typename Pixel>
struct DepthTraits;

/// 32FC1: metres; NaN, infinite or not positive means none.
template <>
struct DepthTraits<float> {
  /// Depth [m]; 0 where there is none.
  [[nodiscard]] static float metres(float depth) { return hasDepth(depth) ? depth : 0.0F; }
  /// Inverse depth [1/m]; 0 where there is none.
  [[nodiscard]] static float inverse(float depth) { return hasDepth(depth) ? 1.0F / depth : 0.0F; }
};

/// 16UC1: millimetres; 0 means none.
template <>
struct DepthTraits<std::uint16_t> {
  /// Depth [m]; 0 where there is none.
  [[nodiscard]] static float metres(std::uint16_t depth) {
    return depth >= 50 ? static_cast<float>(depth) * 0.001F : 0.0F;
  }
  /// Inverse depth [1/m]; 0 where there is none.
  [[nodiscard]] static float inverse(std::uint16_t depth) {
    return depth >= 50 ? 1000.0F / static_cast<float>(depth) : 0.0F;
  }
};

}  // namespace planecloud

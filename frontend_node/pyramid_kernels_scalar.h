// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include "planecloud_slam/frontend_node/pyramid_kernels.h"

/// The scalar loops, which the vector kernels also use for what a vector does not fill.
namespace planecloud::scalar {

/// Depths of one surface differ by less than this share within 2x2 pixels.
inline constexpr float kDepthSpread = 0.05F;
inline constexpr float kInverseDepthSpread = 2.0F * kDepthSpread;

/// Inverse depth of four depths [m], 0 for none: mean over the nearest surface among them.
inline float mergeDepths(float a, float b, float c, float d) {
  const float depths[] = {a, b, c, d};
  float near = std::max(std::max(a, b), std::max(c, d));
  for (const float depth : depths) {
    if (depth > 0.0F) near = std::min(near, depth);
  }
  float sum = 0.0F;
  float count = 0.0F;
  for (const float depth : depths) {
    if (depth <= 0.0F || depth - near >= kDepthSpread * near) continue;
    sum += depth;
    count += 1.0F;
  }
  return count > 0.0F ? count / sum : 0.0F;
}

/// The same for four inverse depths [1/m].
inline float mergeInverseDepths(float a, float b, float c, float d) {
  const float near = std::max(std::max(a, b), std::max(c, d));
  float sum = 0.0F;
  float count = 0.0F;
  for (const float inverse_depth : {a, b, c, d}) {
    if (!(near - inverse_depth < kInverseDepthSpread * near)) continue;
    sum += inverse_depth;
    count += 1.0F;
  }
  return count > 0.0F ? sum / count : 0.0F;
}

/// Pixels [first, count).
inline void halveGrey(const GreyRows& rows, int first, int count, float* made) {
  for (int i = first; i < count; ++i) {
    const std::uint8_t* upper = rows.upper + 2 * i;
    const std::uint8_t* lower = rows.lower + 2 * i;
    made[i] = 0.25F * static_cast<float>(upper[0] + upper[1] + lower[0] + lower[1]);
  }
}

/// Pixels [first, count).
inline void halveDepth(const DepthRows& rows, const DepthRange& range, int first, int count,
                       GreyDepth* made) {
  const auto usable = [&](float z) { return z >= range.least && z <= range.most ? z : 0.0F; };
  for (int i = first; i < count; ++i) {
    const float* upper = rows.upper + 2 * i;
    const float* lower = rows.lower + 2 * i;
    made[i] = {rows.made_grey[i],
               mergeDepths(usable(upper[0]), usable(upper[1]), usable(lower[0]), usable(lower[1]))};
  }
}

/// Pixels [first, count).
inline void halveLevel(const GreyDepth* upper, const GreyDepth* lower, int first, int count,
                       GreyDepth* made) {
  for (int i = first; i < count; ++i) {
    const GreyDepth* a = upper + 2 * i;
    const GreyDepth* b = lower + 2 * i;
    made[i].grey = 0.25F * (a[0].grey + a[1].grey + b[0].grey + b[1].grey);
    made[i].inverse_depth = mergeInverseDepths(a[0].inverse_depth, a[1].inverse_depth,
                                               b[0].inverse_depth, b[1].inverse_depth);
  }
}

}  // namespace planecloud::scalar

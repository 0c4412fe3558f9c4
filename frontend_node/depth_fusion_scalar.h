// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <limits>

#include "planecloud_slam/frontend_node/depth_fusion.h"

namespace planecloud::scalar {

/// A point of a row as the other camera sees it.
struct SeenPoint {
  float x;  ///< [px]
  float y;  ///< [px]
  float q;  ///< inverse depth [1/m]; <= 0: behind the camera
};

inline SeenPoint warpPoint(const FusionWarp& warp, float u, float v, float q) {
  const Eigen::Vector3f point = warp.R * Eigen::Vector3f(u, v, 1.0F) + warp.t * q;
  const auto fx = static_cast<float>(warp.camera.fx), fy = static_cast<float>(warp.camera.fy);
  const auto cx = static_cast<float>(warp.camera.cx), cy = static_cast<float>(warp.camera.cy);
  return {fx * point.x() / point.z() + cx, fy * point.y() / point.z() + cy, q / point.z()};
}

inline bool isInside(const FusionWarp& warp, const SeenPoint& seen) {
  return seen.q > 0.0F && seen.x >= 0.0F && seen.x < static_cast<float>(warp.camera.width - 1) &&
         seen.y >= 0.0F && seen.y < static_cast<float>(warp.camera.height - 1);
}

/// Depth [m] at a real pixel: linear where the four pixels around lie within `tolerance` [m] of
/// each other, else 0.
inline float sampleDepth(ImageView<float> depth, float x, float y, float tolerance) {
  const int column = static_cast<int>(x);
  const int row = static_cast<int>(y);
  const float fx = x - static_cast<float>(column);
  const float fy = y - static_cast<float>(row);
  const float* upper = depth.row(row) + column;
  const float* lower = upper + depth.stride();
  if (!(upper[0] > 0.0F && upper[1] > 0.0F && lower[0] > 0.0F && lower[1] > 0.0F)) return 0.0F;
  const float low = std::min(std::min(upper[0], upper[1]), std::min(lower[0], lower[1]));
  const float high = std::max(std::max(upper[0], upper[1]), std::max(lower[0], lower[1]));
  if (!(high - low < tolerance)) return 0.0F;
  const float top = upper[0] + fx * (upper[1] - upper[0]);
  const float bottom = lower[0] + fx * (lower[1] - lower[0]);
  return top + fy * (bottom - top);
}

/// Pixels [begin, row.count) of `FusionKernels::improve`.
inline void improve(const FusionWarp& warp, const FusionRow& row, ImageView<float> depth,
                    float* mean, std::uint8_t* observations, int begin) {
  for (int i = begin; i < row.count; ++i) {
    const SeenPoint seen = warpPoint(warp, row.u[i], row.v, mean[i]);
    if (!isInside(warp, seen)) continue;
    const float predicted = 1.0F / seen.q;
    const float z = sampleDepth(depth, seen.x, seen.y, 2.0F * warp.gate * predicted * predicted);
    if (z == 0.0F) continue;
    // A depth error is the same length in both views, an inverse depth error is not.
    const float deviation = (predicted - z) * mean[i] * mean[i];
    const auto n = static_cast<float>(observations[i]);
    if (deviation * deviation * n > warp.gate * warp.gate * (n + 1.0F)) continue;
    mean[i] += deviation / (n + 1.0F);
    if (observations[i] < warp.max_observations) ++observations[i];
  }
}

/// Pixels [begin, row.count) of `FusionKernels::project`.
inline void project(const FusionWarp& warp, const FusionRow& row, const float* depth, int* at,
                    float* inverse_depth, int begin) {
  for (int i = begin; i < row.count; ++i) {
    at[i] = -1;
    const float z = depth[i];
    if (!(z > 0.0F && z < std::numeric_limits<float>::infinity())) continue;
    const SeenPoint seen = warpPoint(warp, row.u[i], row.v, 1.0F / z);
    if (!isInside(warp, seen)) continue;
    at[i] = static_cast<int>(seen.y + 0.5F) * warp.camera.width + static_cast<int>(seen.x + 0.5F);
    inverse_depth[i] = seen.q;
  }
}

}  // namespace planecloud::scalar

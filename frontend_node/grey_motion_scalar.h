// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include "planecloud_slam/frontend_node/grey_motion.h"

/// The scalar loop, which the vector kernel also uses for what a vector does not fill.
namespace planecloud::scalar {

/// The last position between two of `count` pixels.
inline float lastPosition(int count) { return static_cast<float>(count - 1) - 1e-3F; }

/// Bilinear, within the image.
inline float sampleGrey(ImageView<float> grey, float x, float y) {
  const int column = static_cast<int>(x);
  const int row = static_cast<int>(y);
  const float fx = x - static_cast<float>(column);
  const float fy = y - static_cast<float>(row);
  const float* upper = grey.row(row) + column;
  const float* lower = upper + grey.stride();
  const float top = upper[0] + fx * (upper[1] - upper[0]);
  const float bottom = lower[0] + fx * (lower[1] - lower[0]);
  return top + fy * (bottom - top);
}

/// Pixels from `first` on.
inline void moveGreyRow(const GreyMotion& motion, ImageView<float> grey, int y, int first,
                        GreyDepth* pixels) {
  const LevelCamera& camera = motion.camera;
  const float v = (static_cast<float>(y) - camera.cy) / camera.fy;
  for (int i = first; i < camera.width; ++i) {
    const float u = (static_cast<float>(i) - camera.cx) / camera.fx;
    const Eigen::Vector3f point =
        motion.R * Eigen::Vector3f(u, v, 1.0F) + motion.t * pixels[i].inverse_depth;
    const float z = std::max(point.z(), 1e-3F);
    const float x_color = camera.fx * point.x() / z + camera.cx;
    const float y_color = camera.fy * point.y() / z + camera.cy;
    pixels[i].grey = sampleGrey(grey, std::clamp(x_color, 0.0F, lastPosition(camera.width)),
                                std::clamp(y_color, 0.0F, lastPosition(camera.height)));
  }
}

}  // namespace planecloud::scalar

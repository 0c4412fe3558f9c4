// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "planecloud_slam/plane_fit/camera.h"
#include "planecloud_slam/plane_fit/plane_cloud.h"

namespace planecloud {

/// What a keyframe saw along a coarse grid of rays: half a kilobyte that stays in memory for every
/// keyframe, enough to predict which keyframes see the same place.
struct ViewSketch {
  struct Sample {
    /// Three digits are enough here.
    using Vector = Eigen::Matrix<Eigen::half, 3, 1>;
    Vector point = Vector::Zero();   ///< in the optical frame [m]
    Vector normal = Vector::Zero();  ///< unit, towards the camera
  };
  CameraIntrinsics camera;
  std::vector<Sample> samples;  ///< of the rays that met a tile
};

/// Ignores lens distortion.
[[nodiscard]] ViewSketch sketchView(const PlaneCloud& planes);

}  // namespace planecloud

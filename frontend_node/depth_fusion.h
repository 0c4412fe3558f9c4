// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "planecloud_slam/plane_fit/camera.h"
#include "planecloud_slam/plane_fit/image_view.h"

/// The inner loops of the local map, over one row of pixels.
namespace planecloud {

/// A rigid motion into a camera without distortion.
struct FusionWarp {
  Eigen::Matrix3f R = Eigen::Matrix3f::Identity();
  Eigen::Vector3f t = Eigen::Vector3f::Zero();  ///< [m]
  CameraIntrinsics camera;
  float gate = 0.0F;                  ///< of one inverse depth [1/m]
  std::uint8_t max_observations = 0;  ///< that count in a mean
};

/// One row of pixels with the tangents of their rays.
struct FusionRow {
  const float* u = nullptr;  ///< tangents of the columns
  float v = 0.0F;            ///< tangent of the row
  int count = 0;             ///< pixels
};

/// Two implementations that agree to rounding.
struct FusionKernels {
  const char* name;
  /// Improves the inverse depths `mean` [1/m, 0: none] of a keyframe's row, each seen in
  /// `observations` frames, by what `depth` [m] of a frame shows of them. `warp` leads from the
  /// keyframe into the frame.
  void (*improve)(const FusionWarp& warp, const FusionRow& row, ImageView<float> depth, float* mean,
                  std::uint8_t* observations);
  /// Where the pixels of a row of `depth` [m] are seen: `at` the index of the nearest pixel, -1
  /// when outside or without depth, and their inverse depth there [1/m].
  void (*project)(const FusionWarp& warp, const FusionRow& row, const float* depth, int* at,
                  float* inverse_depth);
};

[[nodiscard]] const FusionKernels& scalarFusionKernels();
/// The best this processor has; the scalar ones when built without Highway.
[[nodiscard]] const FusionKernels& vectorFusionKernels();

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "planecloud_slam/plane_fit/quadtree_fitter.h"

namespace planecloud {

/// Planes fitted to the depth of a keyframe, looked up by ray: they average more of the noise away
/// than the few pixels around a point. Keeps its workspace.
class PlaneLandmarks {
 public:
  /// `camera` without distortion. Throws std::invalid_argument when the options fail their check.
  PlaneLandmarks(const CameraIntrinsics& camera, const QuadtreeFitterOptions& options);

  /// Fits `depth` [m, NaN: none], of the camera's size.
  void assign(ImageView<float> depth);

  /// Inverse depth (alpha, beta, gamma) [1/m] of the plane seen at tangents (u, v), see PlanarTile;
  /// null where none of at least 8 px side is seen. Valid until the next `assign`.
  [[nodiscard]] const Eigen::Vector3f* find(float u, float v) const;

 private:
  CameraIntrinsics camera_;
  QuadtreeFitter fitter_;
  PlaneCloud cloud_;
  Image<std::uint16_t> tiles_;  ///< one more than the index of a pixel's tile; 0: none
};

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include "planecloud_slam/plane_fit/se3.h"

namespace planecloud {

/// The motions of a camera on a robot that drives on a flat floor: rotation about the vertical,
/// translation across it. They leave the vertical where it is in the camera, so that one direction
/// describes them in every camera frame.
class PlanarMotion {
 public:
  /// `up`: the vertical in the camera frame, of any length.
  explicit PlanarMotion(const Eigen::Vector3d& up);

  /// The planar motion nearest to `T` from one camera frame to another.
  [[nodiscard]] Eigen::Isometry3d nearest(const Eigen::Isometry3d& T) const;

  /// The twists that keep the motion planar are the combinations of these columns: two directions
  /// across the vertical, one rotation about it.
  [[nodiscard]] Eigen::Matrix<double, 6, 3> basis() const;

  /// What is known of a pose without looking, at the camera: floors and chassis give way a little.
  [[nodiscard]] Matrix6d information() const;

 private:
  Eigen::Vector3d up_;
};

}  // namespace planecloud

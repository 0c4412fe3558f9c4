// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "planecloud_slam/plane_fit/plane_cloud.h"

namespace planecloud {

/// What a keyframe sees, at one pixel in 20 x 20: enough to say how much two views share.
class ViewSamples {
 public:
  explicit ViewSamples(const PlaneCloud& cloud);

  /// Share of these samples that a camera with `other` samples sees at the depth they have: inside
  /// its image, in front of it, and agreeing within 0.1 m or 5 % of the depth. 0 without samples.
  [[nodiscard]] double shareSeenBy(const ViewSamples& other,
                                   const Eigen::Isometry3d& T_other_this) const;

 private:
  [[nodiscard]] bool sees(const Eigen::Vector3d& point) const;

  CameraIntrinsics camera_;
  int columns_ = 0;
  int rows_ = 0;
  std::vector<float> depths_;            ///< rows x columns [m], 0: none
  std::vector<Eigen::Vector3d> points_;  ///< of the samples with depth, optical frame [m]
};

}  // namespace planecloud

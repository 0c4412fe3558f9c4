// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "planecloud_slam/frontend_node/frontend.h"
#include "planecloud_slam/plane_fit/se3.h"

namespace planecloud {

/// How uncertain visual odometry is of where the camera is since its first frame: the uncertainty
/// towards the keyframe on top of that of the keyframe, which grows from keyframe to keyframe.
class OdometryCovariance {
 public:
  /// Variance of what is not known at all: lost, or in a segment of unknown relation [m^2, rad^2].
  static constexpr double kUnknown = 1e4;

  /// Takes the results of all frames in their order. Returns the covariance of T_odom_camera in the
  /// tangent space at the camera, translation first [m^2, rad^2].
  [[nodiscard]] Matrix6d update(const FrameResult& result);

 private:
  [[nodiscard]] Matrix6d ofTracked(const FrameResult& result) const;

  std::optional<KeyframeId> reference_;
  Matrix6d of_reference_ = Matrix6d::Zero();  ///< at the reference keyframe
  Matrix6d of_last_ = Matrix6d::Zero();       ///< at the last frame that was tracked
};

}  // namespace planecloud

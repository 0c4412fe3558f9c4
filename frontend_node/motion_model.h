// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "planecloud_slam/plane_fit/se3.h"

namespace planecloud {

/// The camera goes on as it last moved.
class MotionModel {
 public:
  /// The motion of the camera over the last `seconds`, > 0.
  void observe(const Eigen::Isometry3d& T_previous_current, double seconds);
  /// The camera may have turned: nothing is known until the next observation.
  void forget() { velocity_.reset(); }

  /// Motion within `seconds` from now, which may be negative; none when not known.
  [[nodiscard]] std::optional<Eigen::Isometry3d> after(double seconds) const;

  /// Where a camera not seen for `seconds` may be: on as it last moved, forgotten or not, at some
  /// speed and with another turn, or straight ahead.
  [[nodiscard]] std::vector<Eigen::Isometry3d> possibleMotions(double seconds) const;

 private:
  std::optional<Vector6d> velocity_;           ///< [m/s, rad/s], at the camera
  Vector6d last_velocity_ = Vector6d::Zero();  ///< the same, kept
};

}  // namespace planecloud

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
  void forget() { is_known_ = false; }

  /// Motion within `seconds` from now, which may be negative; none when not known.
  [[nodiscard]] std::optional<Eigen::Isometry3d> after(double seconds) const;

  /// Where a camera not seen for `seconds` may be: on as it last moved, forgotten or not, at some
  /// speed and with another turn, or straight ahead.
  [[nodiscard]] std::vector<Eigen::Isometry3d> possibleMotions(double seconds) const;

 private:
  Vector6d velocity_ = Vector6d::Zero();  ///< when last observed [m/s, rad/s], at the camera
  bool is_known_ = false;                 ///< it still holds
};

}  // namespace planecloud

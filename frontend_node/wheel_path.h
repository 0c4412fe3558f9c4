// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "planecloud_slam/plane_fit/se3.h"

namespace planecloud {

/// What the wheels of a floor robot counted: they slip by some percent of all that was driven,
/// there and back, and see nothing of a tilt.
class WheelPath {
 public:
  void add(const Eigen::Isometry3d& T_previous_current);

  /// Information of the pose at the end relative to the beginning, see se3.h [1/m^2, 1/rad^2].
  [[nodiscard]] Matrix6d information() const;

 private:
  double length_ = 0.0;  // [m]
  double turned_ = 0.0;  // [rad]
};

}  // namespace planecloud

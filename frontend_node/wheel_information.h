// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "planecloud_slam/plane_fit/se3.h"

namespace planecloud {

/// What the wheels of a floor robot are worth after motion `T`: they slip by some percent, and see
/// nothing of a tilt. Information of `T`, see se3.h [1/m^2, 1/rad^2].
[[nodiscard]] Matrix6d wheelInformation(const Eigen::Isometry3d& T);

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include "planecloud_slam/backend_node/loop_closure_options.h"
#include "planecloud_slam/plane_fit/se3.h"

namespace planecloud {

/// Turning leads tracking astray as well: this far [m] counts as much as one radian.
constexpr double kMetresPerRadian = 0.5;

/// Length of a motion [m], its rotation included.
[[nodiscard]] double motionLength(const Eigen::Isometry3d& T);

/// What is known of a relative pose obtained by following `path` [m] of odometry: covariance, order
/// (translation, rotation) [m^2, rad^2]. The same in all directions, hence in all frames.
[[nodiscard]] Matrix6d driftCovariance(double path, const DriftOptions& options);

/// Covariance of a measurement. Directions without information get the variance `kUnknownVariance`:
/// they can disagree by any distance that occurs.
[[nodiscard]] Matrix6d measurementCovariance(const Matrix6d& information);

/// Stands for "unknown" in covariances [m^2, rad^2].
constexpr double kUnknownVariance = 1e4;

/// Squared Mahalanobis distance of `error` (6).
[[nodiscard]] double squaredMahalanobis(const Vector6d& error, const Matrix6d& covariance);

}  // namespace planecloud

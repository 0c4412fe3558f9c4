// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Cholesky>
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

/// Covariance of a closure. Directions without information get the variance `kUnknownVariance`.
[[nodiscard]] Matrix6d measurementCovariance(const Matrix6d& information);

/// What a closure says of a direction its planes do not observe [m^2, rad^2]: its keyframes see the
/// same place, so they lie within sight of each other. 3.5 standard deviations are the 7 m a depth
/// camera reaches. With more, pieces of one corridor out of each other's sight would be taken for
/// the same piece as soon as true closures tell where they lie.
constexpr double kUnknownVariance = 4.0;

/// Squared Mahalanobis distance of `error`, a vector of n numbers of n x n `covariance`; both may
/// be expressions.
template <typename Error, typename Covariance>
[[nodiscard]] double squaredMahalanobis(const Eigen::MatrixBase<Error>& error,
                                        const Eigen::MatrixBase<Covariance>& covariance) {
  return error.dot(covariance.ldlt().solve(error));
}

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include "planecloud_slam/backend_node/flat_surface.h"
#include "planecloud_slam/plane_fit/se3.h"

namespace planecloud {

/// How a surface of keyframe `source` misses the plane of one of keyframe `target`, about a
/// relative pose: height of the source's centroid over the target's plane [m], then the components
/// of the source's normal along the target's two axes [rad].
struct Coplanarity {
  Eigen::Vector3d residual = Eigen::Vector3d::Zero();
  /// Derivative by a twist at the source, T <- T Exp(xi).
  Eigen::Matrix<double, 3, 6> jacobian = Eigen::Matrix<double, 3, 6>::Zero();
  /// Of the residual, by the errors of both planes.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

[[nodiscard]] Coplanarity compareSurfaces(const FlatSurface& target, const FlatSurface& source,
                                          const Eigen::Isometry3d& T_target_source);

/// The most likely twist at the source that makes the residual vanish, when `prior` is the
/// covariance of the relative pose.
[[nodiscard]] Vector6d makeCoplanar(const Coplanarity& pair, const Matrix6d& prior);

/// Information on a twist at the source, of rank three.
[[nodiscard]] Matrix6d informationOf(const Coplanarity& pair);

}  // namespace planecloud

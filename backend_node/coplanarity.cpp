// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/backend_node/coplanarity.h"

#include <Eigen/Cholesky>

namespace planecloud {

Coplanarity compareSurfaces(const FlatSurface& target, const FlatSurface& source,
                            const Eigen::Isometry3d& T_target_source) {
  const Eigen::Matrix3d R_target_source = T_target_source.linear();
  const Eigen::Vector3d offset = T_target_source * source.centroid - target.centroid;
  const Eigen::Vector3d source_normal = R_target_source * source.normal;
  Coplanarity pair;
  pair.residual << target.normal.dot(offset), target.axes.transpose() * source_normal;
  const Eigen::Vector3d normal = R_target_source.transpose() * target.normal;
  const Eigen::Matrix<double, 3, 2> axes = R_target_source.transpose() * target.axes;
  pair.jacobian.row(0) << normal.transpose(), source.centroid.cross(normal).transpose();
  for (int k = 0; k < 2; ++k) {
    pair.jacobian.row(1 + k).tail<3>() = source.normal.cross(axes.col(k)).transpose();
  }
  // The errors of the target's slopes grow with the way to the source.
  Eigen::Matrix3d by_target = Eigen::Matrix3d::Identity();
  by_target.row(0) << -1.0, -(target.axes.transpose() * offset).transpose();
  Eigen::Matrix3d by_source = Eigen::Matrix3d::Identity();
  by_source.bottomRightCorner<2, 2>() = -axes.transpose() * source.axes;
  pair.covariance = by_target * target.covariance * by_target.transpose() +
                    by_source * source.covariance * by_source.transpose();
  return pair;
}

Vector6d makeCoplanar(const Coplanarity& pair, const Matrix6d& prior) {
  const Eigen::Matrix<double, 6, 3> spread = prior * pair.jacobian.transpose();
  return -spread * (pair.jacobian * spread).ldlt().solve(pair.residual);
}

Matrix6d informationOf(const Coplanarity& pair) {
  const Matrix6d information =
      pair.jacobian.transpose() * pair.covariance.ldlt().solve(pair.jacobian);
  return 0.5 * (information + information.transpose());
}

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/frontend_node/planar_motion.h"

#include <cmath>

namespace planecloud {
namespace {

/// Standard deviations off the plane.
constexpr double kHeight = 0.005;  // [m]
constexpr double kTilt = 0.005;    // [rad]

}  // namespace

PlanarMotion::PlanarMotion(const Eigen::Vector3d& up) : up_(up.normalized()) {}

Eigen::Isometry3d PlanarMotion::nearest(const Eigen::Isometry3d& T) const {
  // The twist of the swing-twist decomposition is the nearest rotation about the vertical.
  const Eigen::Quaterniond q(T.linear());
  const double angle = 2.0 * std::atan2(q.vec().dot(up_), q.w());
  Eigen::Isometry3d planar = Eigen::Isometry3d::Identity();
  planar.linear() = Eigen::AngleAxisd(angle, up_).toRotationMatrix();
  planar.translation() = T.translation() - up_ * up_.dot(T.translation());
  return planar;
}

Eigen::Matrix<double, 6, 3> PlanarMotion::basis() const {
  const Eigen::Vector3d across = up_.unitOrthogonal();
  Eigen::Matrix<double, 6, 3> basis = Eigen::Matrix<double, 6, 3>::Zero();
  basis.block<3, 1>(0, 0) = across;
  basis.block<3, 1>(0, 1) = up_.cross(across);
  basis.block<3, 1>(3, 2) = up_;
  return basis;
}

Matrix6d PlanarMotion::information() const {
  const Eigen::Matrix3d vertical = up_ * up_.transpose();
  Matrix6d information = Matrix6d::Zero();
  information.topLeftCorner<3, 3>() = vertical / (kHeight * kHeight);
  information.bottomRightCorner<3, 3>() =
      (Eigen::Matrix3d::Identity() - vertical) / (kTilt * kTilt);
  return information;
}

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/plane_fit/se3.h"

#include <cmath>

namespace planecloud {
namespace {

constexpr double kSmallAngle = 1e-5;

/// Left Jacobian of SO(3): `Exp(rho, phi)` translates by `V(phi) * rho`.
Eigen::Matrix3d leftJacobian(const Eigen::Vector3d& phi) {
  const double angle = phi.norm();
  const Eigen::Matrix3d Phi = skew(phi);
  if (angle < kSmallAngle) {
    return Eigen::Matrix3d::Identity() + 0.5 * Phi + Phi * Phi / 6.0;
  }
  const double angle2 = angle * angle;
  return Eigen::Matrix3d::Identity() + (1.0 - std::cos(angle)) / angle2 * Phi +
         (angle - std::sin(angle)) / (angle2 * angle) * Phi * Phi;
}

}  // namespace

Eigen::Matrix3d skew(const Eigen::Vector3d& a) {
  Eigen::Matrix3d A;
  A << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0;
  return A;
}

Eigen::Quaterniond expSo3(const Eigen::Vector3d& phi) {
  const double angle = phi.norm();
  const double half = 0.5 * angle;
  const double scale = angle < kSmallAngle ? 0.5 - angle * angle / 48.0 : std::sin(half) / angle;
  const Eigen::Vector3d v = scale * phi;
  return Eigen::Quaterniond(std::cos(half), v.x(), v.y(), v.z()).normalized();
}

Eigen::Vector3d logSo3(const Eigen::Quaterniond& q) {
  const double sign = q.w() < 0.0 ? -1.0 : 1.0;
  const double w = sign * q.w();
  const Eigen::Vector3d v = sign * q.vec();
  const double n = v.norm();
  if (n < kSmallAngle) return (2.0 / w) * v;
  return (2.0 * std::atan2(n, w) / n) * v;
}

Eigen::Isometry3d expSe3(const Vector6d& xi) {
  const Eigen::Vector3d phi = xi.tail<3>();
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = expSo3(phi).toRotationMatrix();
  T.translation() = leftJacobian(phi) * xi.head<3>();
  return T;
}

Vector6d logSe3(const Eigen::Isometry3d& T) {
  const Eigen::Vector3d phi = logSo3(Eigen::Quaterniond(T.linear()).normalized());
  Vector6d xi;
  xi.head<3>() = leftJacobian(phi).partialPivLu().solve(T.translation());
  xi.tail<3>() = phi;
  return xi;
}

Matrix6d adjoint(const Eigen::Isometry3d& T) {
  Matrix6d A = Matrix6d::Zero();
  A.topLeftCorner<3, 3>() = T.linear();
  A.bottomRightCorner<3, 3>() = T.linear();
  A.topRightCorner<3, 3>() = skew(T.translation()) * T.linear();
  return A;
}

Matrix6d transformCovariance(const Eigen::Isometry3d& T_target_source, const Matrix6d& covariance) {
  const Matrix6d to_target = adjoint(T_target_source);
  return to_target * covariance * to_target.transpose();
}

double rotationAngle(const Eigen::Isometry3d& T) {
  return logSo3(Eigen::Quaterniond(T.linear()).normalized()).norm();
}

Matrix6d invertRelativePoseInformation(const Eigen::Isometry3d& T_a_b,
                                       const Matrix6d& information) {
  // (T_a_b Exp(xi))^-1 = T_b_a Exp(-Ad(T_a_b) xi), so a twist at a is -Ad(T_a_b) of one at b.
  const Matrix6d to_b = adjoint(T_a_b.inverse());
  return to_b.transpose() * information * to_b;
}

}  // namespace planecloud

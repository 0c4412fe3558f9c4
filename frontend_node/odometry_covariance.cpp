// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/frontend_node/odometry_covariance.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace planecloud {
namespace {

/// Inverse of a semi-definite information; directions it knows nothing of get `kUnknown`.
Matrix6d covarianceOf(const Matrix6d& information) {
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(information);
  Vector6d variances;
  for (int i = 0; i < 6; ++i) {
    const double eigenvalue = std::max(solver.eigenvalues()[i], 1.0 / OdometryCovariance::kUnknown);
    variances[i] = 1.0 / eigenvalue;
  }
  return solver.eigenvectors() * variances.asDiagonal() * solver.eigenvectors().transpose();
}

}  // namespace

Matrix6d OdometryCovariance::update(const FrameResult& result) {
  const Matrix6d unknown = kUnknown * Matrix6d::Identity();
  if (result.status == TrackingStatus::kLost) return unknown;
  if (result.status == TrackingStatus::kInitialised) {
    of_reference_ = of_last_ = result.segment > 0 ? unknown : Matrix6d::Zero().eval();
    reference_ = result.reference;
    return of_last_;
  }
  if (reference_ != result.reference) {
    reference_ = result.reference;
    of_reference_ = of_last_;
  }
  of_last_ = ofTracked(result);
  return of_last_;
}

Matrix6d OdometryCovariance::ofTracked(const FrameResult& result) const {
  return transformCovariance(result.T_reference_camera.inverse(), of_reference_) +
         covarianceOf(result.information);
}

}  // namespace planecloud

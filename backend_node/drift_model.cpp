// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/backend_node/drift_model.h"

namespace planecloud {

double motionLength(const Eigen::Isometry3d& T) {
  return T.translation().norm() + kMetresPerRadian * rotationAngle(T);
}

Matrix6d driftCovariance(double path, const DriftOptions& options) {
  const double translation = options.translation_base + options.translation_drift * path;
  const double rotation = options.rotation_base + options.rotation_drift * path;
  Vector6d variances;
  variances.head<3>().setConstant(translation * translation);
  variances.tail<3>().setConstant(rotation * rotation);
  return variances.asDiagonal();
}

Matrix6d measurementCovariance(const Matrix6d& information) {
  const Matrix6d regular = information + Matrix6d::Identity() / kUnknownVariance;
  const Matrix6d covariance = regular.llt().solve(Matrix6d::Identity());
  return 0.5 * (covariance + covariance.transpose());
}

}  // namespace planecloud

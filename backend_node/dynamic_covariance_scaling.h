// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/loss_function.h>

namespace planecloud {

/// Dynamic covariance scaling (Agarwal et al., ICRA 2013) as the kernel it amounts to: errors e
/// up to `width` [sigma] count as they are; beyond it their covariance grows with them, by
/// `s = 2 width^2 / (width^2 + e^2)`, so that a false edge ends up with nearly no pull.
class DynamicCovarianceScaling : public ceres::LossFunction {
 public:
  explicit DynamicCovarianceScaling(double width) : square_(width * width) {}

  /// `rho`: value, first and second derivative at the squared error `square`.
  void Evaluate(double square, double rho[3]) const override;

 private:
  double square_;
};

}  // namespace planecloud

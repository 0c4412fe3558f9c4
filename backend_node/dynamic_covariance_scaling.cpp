// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/backend_node/dynamic_covariance_scaling.h"

namespace planecloud {

void DynamicCovarianceScaling::Evaluate(double square, double rho[3]) const {
  if (square <= square_) {
    rho[0] = square;
    rho[1] = 1.0;
    rho[2] = 0.0;
    return;
  }
  const double sum = square_ + square;
  const double scale = 2.0 * square_ / sum;
  rho[0] = square_ * (3.0 * square - square_) / sum;
  rho[1] = scale * scale;
  rho[2] = -2.0 * scale * scale / sum;
}

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/backend_node/dynamic_covariance_scaling.h"

namespace planecloud {

KernelValue dynamicCovarianceScaling(double square, double width) {
  const double limit = width * width;
  if (square <= limit) return {square, 1.0, 0.0};
  const double sum = limit + square;
  const double scale = 2.0 * limit / sum;
  return {limit * (3.0 * square - limit) / sum, scale * scale, -2.0 * scale * scale / sum};
}

}  // namespace planecloud

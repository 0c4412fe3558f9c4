// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace planecloud {

/// A robust kernel at one squared error.
struct KernelValue {
  double value = 0.0;
  double slope = 1.0;      ///< by the squared error
  double curvature = 0.0;  ///< likewise, second derivative
};

/// Dynamic covariance scaling (Agarwal et al., ICRA 2013) as the kernel it amounts to: errors e up
/// to `width` [sigma] count as they are; beyond it their covariance grows with them, by
/// `s = 2 width^2 / (width^2 + e^2)`, so that a false edge ends up with nearly no pull. `square`:
/// e^2.
[[nodiscard]] KernelValue dynamicCovarianceScaling(double square, double width);

}  // namespace planecloud

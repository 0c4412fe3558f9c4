// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/plane_fit/noise_model.h"

#include <cmath>

namespace planecloud {

void DepthNoiseModel::check() const {
  checkRange("noise/disparity_step", disparity_step, 1e-5, 0.1);
  checkRange("noise/disparity_noise", disparity_noise, 0.0, 10.0);
}

double DepthNoiseModel::inverseDepthSigma() const {
  // A uniform error of one step has variance 1/12 of its square.
  return disparity_step * std::sqrt(disparity_noise * disparity_noise + 1.0 / 12.0);
}

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "planecloud_slam/plane_fit/option_fields.h"

namespace planecloud {

/// Noise of a triangulating depth camera (Kinect, Xtion, Astra): its disparity, hence the inverse
/// depth, has the same noise everywhere, so depth noise grows as z^2. Keys below `noise/`.
struct DepthNoiseModel {
  /// One step of the quantised disparity as inverse depth [1/m], (1/8 px) / (570 px * 75 mm);
  /// [1e-5, 0.1].
  double disparity_step = 2.8e-3;
  /// Standard deviation of the disparity before it is quantised [steps], [0, 10].
  double disparity_noise = 0.5;

  template <typename Self, typename Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("disparity_step", self.disparity_step);
    visit("disparity_noise", self.disparity_noise);
  }
  /// Throws std::invalid_argument that names key, value and range.
  void check() const;

  /// Distance of two neighbouring depth readings at depth `z` [m].
  [[nodiscard]] double depthStep(double z) const { return disparity_step * z * z; }
  /// Standard deviation of inverse depth [1/m], quantisation included.
  [[nodiscard]] double inverseDepthSigma() const;
  /// Standard deviation of the depth [m] read at depth `z` [m].
  [[nodiscard]] double depthSigma(double z) const { return inverseDepthSigma() * z * z; }
};

}  // namespace planecloud

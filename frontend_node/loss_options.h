// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "planecloud_slam/plane_fit/option_fields.h"

namespace planecloud {

/// What makes a track implausible. Loss is an outcome, not an error.
struct LossOptions {
  double min_valid_depth = 0.05;         ///< share of pixels with depth an image needs, [0, 1]
  double min_contrast = 2.0;             ///< standard deviation of grey an image needs, [0, 128]
  double min_overlap = 0.25;             ///< share of the reference's points seen again, [0, 1]
  double min_inliers = 0.5;              ///< share of seen points that agree with the pose, [0, 1]
  double max_depth_residual = 0.1;       ///< scale of inverse depth residuals [1/m], (0, 10]
  double max_intensity_residual = 30.0;  ///< scale of grey residuals, (0, 255]
  /// Grey residuals this many times those of the last good frames, are those of another place or of
  /// something that moves, [1, 100].
  double max_residual_growth = 3.0;
  double min_entropy_ratio = 0.6;  ///< of `KeyframeSelector`, below it nothing holds, [0, 1]
  double max_speed = 3.0;          ///< [m/s], [0.1, 100]
  double max_turn_rate = 4.0;      ///< [rad/s], [0.1, 100]
  /// Standard deviation of the pose in its least certain direction [m], [1e-3, 10].
  double max_deviation = 0.05;
  double max_turn_deviation = 0.05;  ///< the same for rotation [rad], [1e-3, 3]
  /// Motion between two frames and the wheels' may differ by this and a fifth of the motion [m],
  /// [0, 10].
  double max_guess_error = 0.1;
  double max_guess_turn_error = 0.1;  ///< the same for rotation [rad], [0, 3]
  /// Longest time between two frames across which motion is simply followed [s], [0.01, 100]. After
  /// a longer one, as after a loss, an alignment must hold in both directions.
  double max_gap = 0.3;
  /// Time without a track on images good enough for one before a new segment opens [s], [0, 3600].
  double new_segment_after = 2.0;

  template <typename Self, typename Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("min_valid_depth", self.min_valid_depth);
    visit("min_contrast", self.min_contrast);
    visit("min_overlap", self.min_overlap);
    visit("min_inliers", self.min_inliers);
    visit("max_depth_residual", self.max_depth_residual);
    visit("max_intensity_residual", self.max_intensity_residual);
    visit("max_residual_growth", self.max_residual_growth);
    visit("min_entropy_ratio", self.min_entropy_ratio);
    visit("max_speed", self.max_speed);
    visit("max_turn_rate", self.max_turn_rate);
    visit("max_deviation", self.max_deviation);
    visit("max_turn_deviation", self.max_turn_deviation);
    visit("max_guess_error", self.max_guess_error);
    visit("max_guess_turn_error", self.max_guess_turn_error);
    visit("max_gap", self.max_gap);
    visit("new_segment_after", self.new_segment_after);
  }

  /// Throws std::invalid_argument naming key, value and range.
  void check() const;
};

}  // namespace planecloud

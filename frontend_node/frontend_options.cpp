// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/frontend_node/frontend_options.h"

#include <algorithm>
#include <stdexcept>

namespace planecloud {

std::string toString(BrightnessModel model) {
  switch (model) {
    case BrightnessModel::kConstant:
      return "constant";
    case BrightnessModel::kOffset:
      return "offset";
    case BrightnessModel::kGainAndOffset:
      return "gain_and_offset";
  }
  throw std::invalid_argument("unknown brightness model");
}

void fromString(const std::string& text, BrightnessModel& model) {
  for (const BrightnessModel choice :
       {BrightnessModel::kConstant, BrightnessModel::kOffset, BrightnessModel::kGainAndOffset}) {
    if (toString(choice) != text) continue;
    model = choice;
    return;
  }
  throw std::invalid_argument("brightness = " + text +
                              ": must be one of constant, offset, gain_and_offset");
}

void DenseTrackerOptions::check() const {
  checkRange("tracking/finest_width", finest_width, 40, 1920);
  checkRange("tracking/levels", levels, 1, 6);
  checkRange("tracking/min_gradient", min_gradient, 0.0, 255.0);
  checkRange("tracking/textured_share", textured_share, 0.0, 1.0);
  checkRange("tracking/flat_grid_step", flat_grid_step, 1, 64);
  checkRange("tracking/min_depth", min_depth, 0.01, 100.0);
  checkRange("tracking/max_depth", max_depth, std::max(0.1, min_depth), 100.0);
  checkRange("tracking/degrees_of_freedom", degrees_of_freedom, 1.0, 100.0);
  checkRange("tracking/min_sigma_grey", min_sigma_grey, 1e-3, 255.0);
  checkRange("tracking/min_sigma_inverse_depth", min_sigma_inverse_depth, 1e-5, 1.0);
  checkRange("tracking/max_iterations", max_iterations, 1, 1000);
  checkRange("tracking/min_relative_change", min_relative_change, 1e-9, 0.1);
  checkRange("tracking/prior_translation", prior_translation, 0.0, 10.0);
  checkRange("tracking/prior_rotation", prior_rotation, 0.0, 10.0);
  if (information_block != 0) checkRange("tracking/information_block", information_block, 4, 320);
  checkRange("tracking/information_scale", information_scale, 1e-6, 1e3);
}

DenseTrackerOptions DenseTrackerOptions::withoutPrior() const {
  DenseTrackerOptions options = *this;
  options.prior_translation = options.prior_rotation = 0.0;
  return options;
}

void HistoryOptions::check() const {
  checkRange("history/keyframes", keyframes, 1, 1000);
  checkRange("history/edges", edges, 0, 16);
  checkRange("history/trials", trials, 0, 100);
  checkRange("history/min_overlap", min_overlap, 0.0, 1.0);
  checkRange("history/min_inliers", min_inliers, 0.0, 1.0);
  checkRange("history/max_dissimilarity", max_dissimilarity, 0.0, 1.0);
  checkRange("history/candidates", candidates, 0, 100);
}

void LossOptions::check() const {
  checkRange("lost/min_valid_depth", min_valid_depth, 0.0, 1.0);
  checkRange("lost/min_contrast", min_contrast, 0.0, 128.0);
  checkRange("lost/min_overlap", min_overlap, 0.0, 1.0);
  checkRange("lost/min_inliers", min_inliers, 0.0, 1.0);
  checkRange("lost/max_depth_residual", max_depth_residual, 1e-6, 10.0);
  checkRange("lost/max_intensity_residual", max_intensity_residual, 1e-3, 255.0);
  checkRange("lost/max_residual_growth", max_residual_growth, 1.0, 100.0);
  checkRange("lost/min_entropy_ratio", min_entropy_ratio, 0.0, 1.0);
  checkRange("lost/max_speed", max_speed, 0.1, 100.0);
  checkRange("lost/max_turn_rate", max_turn_rate, 0.1, 100.0);
  checkRange("lost/max_deviation", max_deviation, 1e-3, 10.0);
  checkRange("lost/max_turn_deviation", max_turn_deviation, 1e-3, 3.0);
  checkRange("lost/max_guess_error", max_guess_error, 0.0, 10.0);
  checkRange("lost/max_guess_turn_error", max_guess_turn_error, 0.0, 3.0);
  checkRange("lost/max_gap", max_gap, 0.01, 100.0);
  checkRange("lost/new_segment_after", new_segment_after, 0.0, 3600.0);
}

void LocalMapOptions::check() const {
  checkRange("local_map/sigma", sigma, 1e-5, 1.0);
  checkRange("local_map/gate", gate, 0.5, 20.0);
  checkRange("local_map/interval", interval, 1, 100);
  checkRange("local_map/max_observations", max_observations, 1, 255);
}

void FrontendOptions::check() const {
  tracking.check();
  keyframe.check();
  lost.check();
  history.check();
  local_map.check();
  plane_fit.check();
  codec.check();
  texture.check();
}

}  // namespace planecloud

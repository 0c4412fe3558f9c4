// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "planecloud_slam/plane_fit/option_fields.h"

namespace planecloud {

/// What may change between two images besides the pose: exposure drifts on real cameras.
enum class BrightnessModel {
  kConstant,       ///< grey values stay
  kOffset,         ///< one offset per image
  kGainAndOffset,  ///< one gain and one offset per image
};

/// "constant", "offset" or "gain_and_offset".
[[nodiscard]] std::string toString(BrightnessModel model);
/// Throws std::invalid_argument naming the choices.
void fromString(const std::string& text, BrightnessModel& model);

/// Options of `DenseTracker` and of what it aligns (Kerl et al., ICRA and IROS 2013).
struct DenseTrackerOptions {
  int finest_width = 320;  ///< widest pyramid level tracked [px], [40, 1920]
  int levels = 3;          ///< number of levels, each half the one before, [1, 6]

  double min_gradient = 2.0;     ///< grey levels per pixel a textured pixel needs, [0, 255]
  double textured_share = 0.25;  ///< of a level's pixels kept for their texture at most, [0, 1]
  int flat_grid_step = 4;        ///< grid of the pixels kept for their depth alone [px], [1, 64]
  /// Depth of the keyframe's pixels from the plane fitted there, where it agrees, instead of the
  /// few pixels around: less noise, but what is nearly flat becomes flat.
  bool plane_landmarks = true;
  /// Where the stamps of colour and depth differ, colour is moved to where it was seen when the
  /// depth was taken, by the camera's velocity; false: as if they had been taken at once.
  bool color_motion = true;
  double min_depth = 0.2;  ///< nearest depth used [m], [0.01, 100]
  double max_depth = 8.0;  ///< farthest depth used [m], [0.1, 100]

  double degrees_of_freedom = 5.0;  ///< nu of the t-distribution, [1, 100]
  double min_sigma_grey = 0.3;      ///< least scale of the grey residuals, (0, 255]
  /// Least scale of the inverse depth residuals [1/m], [1e-5, 1]. Colour and depth are exposed up
  /// to half a frame apart and depth errors are alike over whole regions, so that depth residuals
  /// that look perfect must not outvote the grey ones.
  double min_sigma_inverse_depth = 0.03;
  int max_iterations = 50;            ///< per level, [1, 1000]
  double min_relative_change = 5e-4;  ///< of the cost, below it a level is done, [1e-9, 0.1]
  BrightnessModel brightness = BrightnessModel::kGainAndOffset;

  /// Standard deviation of the guessed motion [m] and [rad]; 0: the guess only starts the search.
  double prior_translation = 0.05;  ///< [m], [0, 10]
  double prior_rotation = 0.05;     ///< [rad], [0, 10]

  /// Side of the image blocks whose residuals count as one sample of the correlated error when
  /// the information is made honest [px of the finest level], [4, 320]; 0: pixels independent.
  int information_block = 40;
  /// Factor on the information handed out, [1e-6, 1e3]: what blocks do not see of the errors, first
  /// of all that the reference's own noise is the same in every frame aligned to it. A fifth makes
  /// the normalised error squared of the hallway's edges (seeds 1 and 2) that of six degrees of
  /// freedom; `bench_tracking --information` shows it for others.
  double information_scale = 0.2;

  template <typename Self, typename Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("finest_width", self.finest_width);
    visit("levels", self.levels);
    visit("min_gradient", self.min_gradient);
    visit("textured_share", self.textured_share);
    visit("flat_grid_step", self.flat_grid_step);
    visit("plane_landmarks", self.plane_landmarks);
    visit("color_motion", self.color_motion);
    visit("min_depth", self.min_depth);
    visit("max_depth", self.max_depth);
    visit("degrees_of_freedom", self.degrees_of_freedom);
    visit("min_sigma_grey", self.min_sigma_grey);
    visit("min_sigma_inverse_depth", self.min_sigma_inverse_depth);
    visit("max_iterations", self.max_iterations);
    visit("min_relative_change", self.min_relative_change);
    visit("brightness", self.brightness);
    visit("prior_translation", self.prior_translation);
    visit("prior_rotation", self.prior_rotation);
    visit("information_block", self.information_block);
    visit("information_scale", self.information_scale);
  }

  /// Throws std::invalid_argument naming key, value and range.
  void check() const;

  /// The same without a motion prior: for images whose motion nothing is known of.
  [[nodiscard]] DenseTrackerOptions withoutPrior() const;
};

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>

#include "planecloud_slam/plane_fit/option_fields.h"

namespace planecloud {

/// How plane clouds are prepared for alignment.
struct PlaneSetOptions {
  int coarse_tile = 16;         ///< largest piece of a tile in the first stage [px], [4, 64]
  int fine_tile = 8;            ///< largest piece of a tile in the second stage [px], [2, 64]
  int min_tile = 3;             ///< tiles with a smaller side are left out [px], [1, 64]
  double max_depth = 6.0;       ///< tiles beyond are left out [m], [0.5, 50]
  double min_incidence = 0.12;  ///< least cosine between normal and ray [-], [0, 0.9]
  int coarse_kept = 320;        ///< pieces of the target in the first stage, [16, 100000]
  int fine_patches = 1000;      ///< pieces used in the second stage, [16, 100000]
  /// Standard deviation of a pixel's depth divided by the depth squared [1/m], [1e-5, 0.1].
  double depth_noise = 1.6e-3;
  /// Error of inverse depth that neighbouring pixels share (lens, calibration) [1/m], [0, 0.1].
  double depth_bias = 0.001;
  /// Pixels this far apart have independent depth errors [px], [1, 32].
  double noise_correlation = 5.0;

  template <typename Self, typename Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("coarse_tile", self.coarse_tile);
    visit("fine_tile", self.fine_tile);
    visit("min_tile", self.min_tile);
    visit("max_depth", self.max_depth);
    visit("min_incidence", self.min_incidence);
    visit("coarse_kept", self.coarse_kept);
    visit("fine_patches", self.fine_patches);
    visit("depth_noise", self.depth_noise);
    visit("depth_bias", self.depth_bias);
    visit("noise_correlation", self.noise_correlation);
  }
  /// Throws std::invalid_argument naming key, value and range.
  void check() const;
};

/// When a tile of one keyframe agrees with what another one saw.
struct VisibilityOptions {
  double depth_tolerance = 0.05;      ///< along the ray at 0 m [m], (0, 1]
  double depth_tolerance_z2 = 0.006;  ///< added times the depth squared [1/m], [0, 0.1]
  double normal_tolerance = 0.5;      ///< angle between agreeing normals [rad], (0, 1.6]

  template <typename Self, typename Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("depth_tolerance", self.depth_tolerance);
    visit("depth_tolerance_z2", self.depth_tolerance_z2);
    visit("normal_tolerance", self.normal_tolerance);
  }
  /// Throws std::invalid_argument naming key, value and range.
  void check() const;
};

enum class IcapForm {
  kPaper,   ///< Algorithm 2 as printed: coefficient space, closed form, all planes equal
  kRobust,  ///< distances at centroids, extents, noise weights, robust kernel, null directions
};

[[nodiscard]] std::string toString(IcapForm form);
/// Throws std::invalid_argument naming the choices.
void fromString(const std::string& text, IcapForm& form);

/// Iterative Closest Algebraic Plane (paper sec. 3.4). Keys: `icap/...`.
struct IcapOptions {
  IcapForm form = IcapForm::kRobust;
  int max_iterations = 30;        ///< all stages together, [1, 200]
  int min_matches = 12;           ///< fewer: too_few_planes, [3, 10000]
  bool restarts = true;           ///< also from other turns and places where the views disagree
  int coarse_patches = 200;       ///< source pieces used in the first stage, [16, 100000]
  double initial_distance = 1.2;  ///< matching gate at the start [m], (0, 5]
  double final_distance = 0.08;   ///< matching gate at the end [m], (0, 5]
  /// Makes a difference of unit normals a length when patches are matched, in either stage [m],
  /// (0, 10]: large where the guess is far off, for normals tell more than places then.
  double coarse_normal_length = 1.0;
  double fine_normal_length = 0.3;
  double initial_angle = 0.87;    ///< matching gate of normals at the start [rad], (0, 3.2]
  double final_angle = 0.3;       ///< matching gate of normals at the end [rad], (0, 3.2]
  double distance_floor = 0.004;  ///< least standard deviation of a plane distance [m], (0, 1]
  double normal_floor = 0.02;     ///< least standard deviation of a normal [rad], (0, 1]
  /// Geman-McClure, in standard deviations [-], [0.5, 100]: narrow while the answer is looked for,
  /// so that wrong matches do not lead away, and for what is observed and how well; wide for the
  /// last steps, when most are right and each that is left out costs precision (an MM-estimate).
  double kernel_width = 4.0;
  double final_kernel_width = 8.0;
  /// A direction counts as observed, and gets information, when its eigenvalue is this many times
  /// what the noise of the normals alone would make [-], [0, 1000]. Noise alone gives 1.
  double observability = 2.0;
  double max_correction = 1.5;  ///< a longer way from the guess is divergence [m], (0, 100]
  double max_rotation = 0.8;    ///< a larger turn from the guess is divergence [rad], (0, 3.2]
  /// Errors that do not average out (sensor distortion): the standard deviation no observed
  /// direction goes below [m], [0, 1], and [rad], [0, 1].
  double translation_floor = 0.015;
  double rotation_floor = 0.01;
  PlaneSetOptions planes;
  VisibilityOptions visibility;

  template <typename Self, typename Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("form", self.form);
    visit("max_iterations", self.max_iterations);
    visit("min_matches", self.min_matches);
    visit("restarts", self.restarts);
    visit("coarse_patches", self.coarse_patches);
    visit("initial_distance", self.initial_distance);
    visit("final_distance", self.final_distance);
    visit("coarse_normal_length", self.coarse_normal_length);
    visit("fine_normal_length", self.fine_normal_length);
    visit("initial_angle", self.initial_angle);
    visit("final_angle", self.final_angle);
    visit("distance_floor", self.distance_floor);
    visit("normal_floor", self.normal_floor);
    visit("kernel_width", self.kernel_width);
    visit("final_kernel_width", self.final_kernel_width);
    visit("observability", self.observability);
    visit("max_correction", self.max_correction);
    visit("max_rotation", self.max_rotation);
    visit("translation_floor", self.translation_floor);
    visit("rotation_floor", self.rotation_floor);
    PlaneSetOptions::fields(self.planes, visit);
    VisibilityOptions::fields(self.visibility, visit);
  }
  /// Throws std::invalid_argument naming key, value and range.
  void check() const;
};

}  // namespace planecloud

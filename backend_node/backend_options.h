// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "planecloud_slam/backend_node/loop_closure_options.h"
#include "planecloud_slam/icap/icap_options.h"
#include "planecloud_slam/plane_fit/option_fields.h"

namespace planecloud {

/// Robust kernel on the squared error of closures and history edges.
enum class RobustKernel {
  kNone,
  kHuber,
  kCauchy,
  kDcs,  ///< dynamic covariance scaling
};

[[nodiscard]] std::string toString(RobustKernel kernel);
/// Throws std::invalid_argument naming the choices.
void fromString(const std::string& text, RobustKernel& kernel);

/// Optimisation of the pose graph. Keys: `graph/...`.
struct PoseGraphOptions {
  RobustKernel kernel = RobustKernel::kCauchy;
  double kernel_width = 3.0;  ///< error where an edge begins to lose weight [sigma], (0, 100]
  int max_iterations = 50;    ///< [1, 1000]
  /// Keyframes around a new closure that are optimised at once; a larger map is optimised as a
  /// whole later (Backend::optimisationDue), [10, 100000].
  int local_window = 400;
  int threads = 1;  ///< more than one: results may differ in the last bits, [1, 256]
  /// Errors of the frontend's edges that do not average out over pixels: their standard deviation
  /// goes below neither of these [m], [0, 1], and [rad], [0, 1].
  double odometry_translation_floor = 0.005;
  double odometry_rotation_floor = 0.003;
  /// Squared Mahalanobis distance above which a closure is found false after optimisation and
  /// leaves again, (0, 1e6]: what 1 of 20 honest ones exceeds by chance (6 degrees of freedom).
  double removal_distance = 12.6;

  template <typename Self, typename Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("kernel", self.kernel);
    visit("kernel_width", self.kernel_width);
    visit("max_iterations", self.max_iterations);
    visit("local_window", self.local_window);
    visit("threads", self.threads);
    visit("odometry_translation_floor", self.odometry_translation_floor);
    visit("odometry_rotation_floor", self.odometry_rotation_floor);
    visit("removal_distance", self.removal_distance);
  }
  /// Throws std::invalid_argument naming key, value and range.
  void check() const;
};

/// Frame of the map. Keys: `map/...`.
struct MapFrameOptions {
  /// z of the map up from the floor the first keyframes saw; else z of the odometry frame.
  bool level_with_floor = true;
  int level_keyframes = 10;      ///< of a component, among which the floor is looked for, [1, 1000]
  double max_floor_tilt = 0.35;  ///< of the floor against the odometry frame [rad], [0, 1.5]

  template <typename Self, typename Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("level_with_floor", self.level_with_floor);
    visit("level_keyframes", self.level_keyframes);
    visit("max_floor_tilt", self.max_floor_tilt);
  }
  /// Throws std::invalid_argument naming key, value and range.
  void check() const;
};

/// Everything the backend can be told.
struct BackendOptions {
  IcapOptions icap;
  LoopClosureOptions loop_closure;
  PoseGraphOptions graph;
  MapFrameOptions map;

  template <typename Self, typename Visit>
  static void fields(Self& self, Visit&& visit) {
    visitFields("icap/", self.icap, visit);
    visitFields("loop_closure/", self.loop_closure, visit);
    visitFields("graph/", self.graph, visit);
    visitFields("map/", self.map, visit);
  }
  /// Throws std::invalid_argument naming key, value and range.
  void check() const;
};

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "planecloud_slam/plane_fit/option_fields.h"

namespace planecloud {

/// Which pairs of keyframes are tried as loop closures.
struct LoopCandidateOptions {
  bool enabled = true;
  double search_radius = 1.5;       ///< between camera positions, known exactly [m], [0.1, 20]
  double max_search_radius = 4.0;   ///< however uncertain the pose is [m], [0.1, 50]
  double max_view_angle = 1.3;      ///< between optical axes [rad], (0, 3.2]
  double min_view_overlap = 0.25;   ///< predicted share of the source in the target's view, [0, 1]
  double min_path_gap = 3.0;        ///< own path between two keyframes of a session [m], [0, 100]
  int max_spatial = 3;              ///< candidates tried per keyframe, [0, 100]
  int max_appearance = 3;           ///< the same, from other components by appearance, [0, 100]
  double max_dissimilarity = 0.35;  ///< of appearance descriptors, [0, 1]

  template <typename Self, typename Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("enabled", self.enabled);
    visit("search_radius", self.search_radius);
    visit("max_search_radius", self.max_search_radius);
    visit("max_view_angle", self.max_view_angle);
    visit("min_view_overlap", self.min_view_overlap);
    visit("min_path_gap", self.min_path_gap);
    visit("max_spatial", self.max_spatial);
    visit("max_appearance", self.max_appearance);
    visit("max_dissimilarity", self.max_dissimilarity);
  }
  /// Throws std::invalid_argument naming key, value and range.
  void check() const;
};

/// How odometry goes astray with the length of the path, one standard deviation. A metre of path is
/// a metre travelled or `kMetresPerRadian` turned (see drift_model.h).
struct DriftOptions {
  double translation_drift = 0.02;  ///< per metre of path [-], [0, 1]
  double rotation_drift = 0.01;     ///< per metre of path [rad/m], [0, 1]
  double translation_base = 0.02;   ///< even over no path [m], (0, 1]
  double rotation_base = 0.015;     ///< even over no path [rad], (0, 1]

  template <typename Self, typename Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("translation_drift", self.translation_drift);
    visit("rotation_drift", self.rotation_drift);
    visit("translation_base", self.translation_base);
    visit("rotation_base", self.rotation_base);
  }
  /// Throws std::invalid_argument naming key, value and range.
  void check() const;
};

/// What an aligned pair must show before it counts as a measurement.
struct ClosureVerificationOptions {
  double min_overlap = 0.6;        ///< agreeing share of the tiles that should be visible, [0, 1]
  double min_view = 0.2;           ///< share of each keyframe in the other's view, [0, 1]
  double max_residual = 0.03;      ///< RMS algebraic error [m], (0, 1]
  double max_seen_through = 0.12;  ///< share of tiles where the other saw through, [0, 1]
  double max_inconsistency =
      16.8;  ///< squared Mahalanobis distance, 6 degrees of freedom, (0, 1e3]
  /// A different answer from another start whose overlap comes within this of the best makes the
  /// pair ambiguous, [0, 1].
  double ambiguity_margin = 0.08;
  /// In place of `min_overlap` and `max_seen_through` where no odometry speaks for a pair, [0, 1].
  double unlocated_min_overlap = 0.85;
  double unlocated_max_seen_through = 0.05;

  template <typename Self, typename Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("min_overlap", self.min_overlap);
    visit("min_view", self.min_view);
    visit("max_residual", self.max_residual);
    visit("max_seen_through", self.max_seen_through);
    visit("max_inconsistency", self.max_inconsistency);
    visit("ambiguity_margin", self.ambiguity_margin);
    visit("unlocated_min_overlap", self.unlocated_min_overlap);
    visit("unlocated_max_seen_through", self.unlocated_max_seen_through);
  }
  /// Throws std::invalid_argument naming key, value and range.
  void check() const;
};

/// How many closures must agree with one another before they enter the graph.
struct ClosureConsistencyOptions {
  int min_intra = 2;           ///< inside one component, [1, 20]
  int min_inter = 4;           ///< to join two components, [1, 20]
  double max_distance = 12.6;  ///< squared Mahalanobis distance of a pair, (0, 1e3]
  double max_path = 4.0;       ///< of each side between two closures that may vouch [m], [0, 1e3]
  double join_translation = 0.1;  ///< the transform that joins must be known to [m], (0, 10]
  double join_rotation = 0.05;    ///< and to [rad], (0, 1]
  /// Keyframes this near to the closures that join are checked for free space as well, whether they
  /// proposed the join or not [m], [0, 100] ...
  double join_check_path = 5.0;
  /// ... and see through at most this share of each other's tiles on average, [0, 1].
  double join_seen_through = 0.03;
  int max_pending = 400;  ///< closures that wait for others; the oldest go, [1, 100000]

  template <typename Self, typename Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("min_intra", self.min_intra);
    visit("min_inter", self.min_inter);
    visit("max_distance", self.max_distance);
    visit("max_path", self.max_path);
    visit("join_translation", self.join_translation);
    visit("join_rotation", self.join_rotation);
    visit("join_check_path", self.join_check_path);
    visit("join_seen_through", self.join_seen_through);
    visit("max_pending", self.max_pending);
  }
  /// Throws std::invalid_argument naming key, value and range.
  void check() const;
};

/// Edges between keyframes whose views hardly overlap but which see two parts of one flat surface.
/// Worth, in the rendered hallway of seeds 1, 2 and 3: ATE 3.1, 4.4 and 3.7 mm with loop closures
/// become 2.7, 2.9 and 3.0 mm; without closures 12.7, 9.0 and 9.4 mm become 14.2, 4.1 and 4.5 mm.
/// A desk (fr1/xyz) has no such surface. Off: no recording of a real building has judged it.
struct CoplanarityOptions {
  bool enabled = false;
  double min_area = 1.0;      ///< of either part [m^2], [0.1, 100]
  double max_distance = 5.0;  ///< between the centres of the parts [m], [0.5, 50]
  double max_path = 15.0;     ///< of measurements between the keyframes [m], [0, 1000]
  int max_edges = 2;          ///< per keyframe, the most telling ones, [1, 10]
  /// Squared Mahalanobis distance from the predicted relative pose, 3 degrees of freedom, (0, 1e3].
  double max_inconsistency = 11.3;

  template <typename Self, typename Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("enabled", self.enabled);
    visit("min_area", self.min_area);
    visit("max_distance", self.max_distance);
    visit("max_path", self.max_path);
    visit("max_edges", self.max_edges);
    visit("max_inconsistency", self.max_inconsistency);
  }
  /// Throws std::invalid_argument naming key, value and range.
  void check() const;
};

/// Loop closure as a whole. Keys: `loop_closure/...`.
struct LoopClosureOptions {
  LoopCandidateOptions candidates;
  DriftOptions drift;
  ClosureVerificationOptions verification;
  ClosureConsistencyOptions consistency;
  CoplanarityOptions coplanarity;

  template <typename Self, typename Visit>
  static void fields(Self& self, Visit&& visit) {
    LoopCandidateOptions::fields(self.candidates, visit);
    visitFields("drift/", self.drift, visit);
    visitFields("verification/", self.verification, visit);
    visitFields("consistency/", self.consistency, visit);
    visitFields("coplanarity/", self.coplanarity, visit);
  }
  /// Throws std::invalid_argument naming key, value and range.
  void check() const;
};

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "planecloud_slam/plane_fit/option_fields.h"

namespace planecloud {

/// The short-term history: the last keyframes, kept to come back to and to measure against.
struct HistoryOptions {
  int keyframes = 40;         ///< kept, 1 MB each at 320 x 240, [1, 1000]
  int edges = 3;              ///< measured per keyframe besides the one to its predecessor, [0, 16]
  int trials = 6;             ///< alignments per keyframe to find them, [0, 100]
  double min_overlap = 0.55;  ///< mutual share of points in view an edge needs, [0, 1]
  double min_inliers = 0.7;   ///< share of these that agree in depth, [0, 1]
  /// Appearance above which a keyframe is not tried where its relation is unknown, [0, 1].
  double max_dissimilarity = 0.35;
  int candidates = 3;  ///< keyframes a lost frame is compared with by their appearance, [0, 100]

  template <typename Self, typename Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("keyframes", self.keyframes);
    visit("edges", self.edges);
    visit("trials", self.trials);
    visit("min_overlap", self.min_overlap);
    visit("min_inliers", self.min_inliers);
    visit("max_dissimilarity", self.max_dissimilarity);
    visit("candidates", self.candidates);
  }

  /// Throws std::invalid_argument naming key, value and range.
  void check() const;
};

}  // namespace planecloud

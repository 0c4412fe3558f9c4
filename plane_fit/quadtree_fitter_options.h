// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "planecloud_slam/plane_fit/option_fields.h"

namespace planecloud {

/// How the allowed mean error of a tile grows with its depth z.
enum class AcceptanceRule {
  kFixed,          ///< tolerance (the paper's results: 13.1 and 2.7 mm)
  kLinearInDepth,  ///< tolerance * z / (1 m) (paper Algorithm 1: `err < eps * avgDepth`)
  kNoiseScaled,    ///< tolerance * z^2 / (1 m^2): the same error in inverse depth everywhere
};
[[nodiscard]] std::string toString(AcceptanceRule rule);
void fromString(const std::string& text, AcceptanceRule& rule);

/// Which depth pixels must exist before a tile is fitted (paper sec. 3.3, `checkTileDepth`).
enum class CornerCheck {
  kNone,
  kWindow,  ///< a valid pixel near each corner: within half the tile's side, at most 4 px
  kExact,   ///< the four corner pixels themselves (the paper)
};
[[nodiscard]] std::string toString(CornerCheck check);
void fromString(const std::string& text, CornerCheck& check);

/// Options of `QuadtreeFitter`, keys below `plane_fit/`.
struct QuadtreeFitterOptions {
  int initial_tile_width = 64;   ///< root tiles [px], [2, 80]
  int initial_tile_height = 64;  ///< root tiles [px], [2, 80]
  int min_tile = 4;              ///< longest side of the smallest tiles [px], [2, 64]
  AcceptanceRule acceptance = AcceptanceRule::kNoiseScaled;
  double tolerance = 0.003;  ///< allowed mean error at 1 m depth [m], [1e-5, 1]
  /// Also bounds the mean error along the viewing ray, not only point to plane: refuses planes
  /// that nearly contain the rays across a depth jump ("curtains").
  bool along_ray_test = true;
  CornerCheck corner_check = CornerCheck::kWindow;
  double min_fill = 0.3;  ///< share of a tile's pixels that must have depth, [0, 1]
  /// The fourth corner may lie this many tolerances off the plane of the three others before the
  /// tile is subdivided unfitted; 0: no such check. [0, 1000]
  double planarity_factor = 8.0;
  /// What a bit of the coded cloud must save: error in tolerances, summed over pixels. The tree is
  /// pruned to the least distortion + lambda * bits, so that `tolerance` is what errors are counted
  /// in, no bound. 0: the paper's rule, the largest tiles that obey the tolerance. [0, 1000]
  double lambda = 6.0;
  double time_budget = 0.0;  ///< per keyframe [s], 0: none, [0, 10]
  int byte_budget = 0;       ///< per keyframe [B], 0: none, [0, 2^30]

  template <typename Self, typename Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("initial_tile_width", self.initial_tile_width);
    visit("initial_tile_height", self.initial_tile_height);
    visit("min_tile", self.min_tile);
    visit("acceptance", self.acceptance);
    visit("tolerance", self.tolerance);
    visit("along_ray_test", self.along_ray_test);
    visit("corner_check", self.corner_check);
    visit("min_fill", self.min_fill);
    visit("planarity_factor", self.planarity_factor);
    visit("lambda", self.lambda);
    visit("time_budget", self.time_budget);
    visit("byte_budget", self.byte_budget);
  }
  /// Throws std::invalid_argument that names key, value and range.
  void check() const;
};

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/plane_fit/quadtree_fitter_options.h"

#include <algorithm>
#include <stdexcept>

namespace planecloud {

std::string toString(AcceptanceRule rule) {
  switch (rule) {
    case AcceptanceRule::kFixed:
      return "fixed";
    case AcceptanceRule::kLinearInDepth:
      return "linear_in_depth";
    case AcceptanceRule::kNoiseScaled:
      break;
  }
  return "noise_scaled";
}

void fromString(const std::string& text, AcceptanceRule& rule) {
  for (const AcceptanceRule candidate :
       {AcceptanceRule::kFixed, AcceptanceRule::kLinearInDepth, AcceptanceRule::kNoiseScaled}) {
    if (text != toString(candidate)) continue;
    rule = candidate;
    return;
  }
  throw std::invalid_argument("acceptance '" + text +
                              "': must be fixed, linear_in_depth or noise_scaled");
}

std::string toString(CornerCheck check) {
  switch (check) {
    case CornerCheck::kNone:
      return "none";
    case CornerCheck::kWindow:
      return "window";
    case CornerCheck::kExact:
      break;
  }
  return "exact";
}

void fromString(const std::string& text, CornerCheck& check) {
  for (const CornerCheck candidate :
       {CornerCheck::kNone, CornerCheck::kWindow, CornerCheck::kExact}) {
    if (text != toString(candidate)) continue;
    check = candidate;
    return;
  }
  throw std::invalid_argument("corner_check '" + text + "': must be none, window or exact");
}

void QuadtreeFitterOptions::check() const {
  checkRange("plane_fit/initial_tile_width", initial_tile_width, 2, 80);
  checkRange("plane_fit/initial_tile_height", initial_tile_height, 2, 80);
  checkRange("plane_fit/min_tile", min_tile, 2,
             std::min({initial_tile_width, initial_tile_height, 64}));
  checkRange("plane_fit/tolerance", tolerance, 1e-5, 1.0);
  checkRange("plane_fit/min_fill", min_fill, 0.0, 1.0);
  checkRange("plane_fit/planarity_factor", planarity_factor, 0.0, 1000.0);
  checkRange("plane_fit/lambda", lambda, 0.0, 1000.0);
  checkRange("plane_fit/time_budget", time_budget, 0.0, 10.0);
  checkRange("plane_fit/byte_budget", byte_budget, 0, 1 << 30);
}

}  // namespace planecloud

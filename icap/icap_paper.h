// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "planecloud_slam/icap/icap_options.h"
#include "planecloud_slam/icap/patch_matcher.h"
#include "planecloud_slam/icap/plane_set.h"

namespace planecloud {

/// What Algorithm 2 of the paper ends with.
struct PaperAlignment {
  Eigen::Isometry3d T_target_source = Eigen::Isometry3d::Identity();
  bool settled = false;  ///< the change of the transform fell below its threshold
  int iterations = 0;
  std::vector<PatchMatch> matches;  ///< of the last iteration, whole tiles
};

/// Algorithm 2 to the letter: every source plane pairs with the target plane whose four
/// coefficients are nearest after the current guess (unit normal and metres in one sum), all pairs
/// weigh the same, every direction of the translation is solved. Kept to be measured against; it
/// fails in corridors.
[[nodiscard]] PaperAlignment alignAsPrinted(const PlaneSet& target, const PlaneSet& source,
                                            const Eigen::Isometry3d& T_target_source_guess,
                                            int max_iterations);

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

#include "planecloud_slam/icap/plane_set.h"

namespace planecloud {

/// Patches that are taken for the same piece of surface.
struct PatchMatch {
  const PlanePatch* target = nullptr;
  const PlanePatch* source = nullptr;
};

/// How far matched patches may be apart.
struct MatchGates {
  double distance = 0.5;       ///< [m]
  double angle = 0.87;         ///< between normals [rad]
  double normal_length = 0.3;  ///< makes a difference of unit normals a length [m]
};

/// The cheapest target of each of the first `count` coarse source patches, in source order, found
/// anywhere within the gates: for guesses that are far off. See nearestPatch for the cost.
[[nodiscard]] std::vector<PatchMatch> matchAnywhere(const PlaneSet& target, const PlaneSet& source,
                                                    const Eigen::Isometry3d& T_target_source,
                                                    const MatchGates& gates, std::size_t count);

/// The target tile that each of the first `count` fine source patches falls upon in the target's
/// image, or one close by in the image when that costs less: for guesses that are nearly right.
/// Much faster, and knows the true extents of tiles.
[[nodiscard]] std::vector<PatchMatch> matchInView(const PlaneSet& target, const PlaneSet& source,
                                                  const Eigen::Isometry3d& T_target_source,
                                                  const MatchGates& gates, std::size_t count);

}  // namespace planecloud

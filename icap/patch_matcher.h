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
  double distance = 0.5;  ///< [m]
  double angle = 0.87;    ///< between normals [rad]
};

/// Pairs source patches with target patches. The cost of a pair is
/// (plane distance at the centroid)^2 + (in-plane gap beyond both radii)^2 + (normal_length
/// |dn|)^2.
class PatchMatcher {
 public:
  /// Matches at most `max_patches` source patches of `level`; both sets must outlive the matcher.
  PatchMatcher(const PlaneSet& target, const PlaneSet& source, PlaneSet::Level level,
               int max_patches);

  /// The cheapest target of each source patch that passes the gates, in source order.
  [[nodiscard]] std::vector<PatchMatch> match(const Eigen::Isometry3d& T_target_source,
                                              const MatchGates& gates) const;

 private:
  const PlaneSet& target_;
  const PlaneSet& source_;
  PlaneSet::Level level_;
  std::size_t source_count_;
};

}  // namespace planecloud

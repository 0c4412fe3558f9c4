// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include "planecloud_slam/icap/icap_options.h"
#include "planecloud_slam/icap/plane_set.h"

namespace planecloud {

/// What the target's camera says of the source's fine pieces once they are moved into its frame.
/// Shares are weighted by the pixels of the pieces.
struct VisibilityReport {
  double total = 0.0;         ///< all fine pieces of the source, a sample of its view [px]
  double in_view = 0.0;       ///< projected into the target's image, facing its camera [px]
  double agreeing = 0.0;      ///< on a tile of the target, same orientation [px]
  double differing = 0.0;     ///< at the target's depth but of another orientation [px]
  double occluded = 0.0;      ///< behind what the target saw: says nothing [px]
  double seen_through = 0.0;  ///< in front of what the target saw: contradicts the pose [px]
  double unknown = 0.0;       ///< where the target has no tile [px]

  /// Of the pieces the target should see, the share that agrees, [0, 1].
  [[nodiscard]] double overlap() const;
  /// Of the pieces the target has an opinion on, the share it saw through, [0, 1].
  [[nodiscard]] double seenThroughShare() const;
  /// Share of the source that falls into the target's view, [0, 1].
  [[nodiscard]] double viewShare() const;
};

/// Call it both ways to test a closure: free space of either keyframe may contradict.
[[nodiscard]] VisibilityReport checkVisibility(
    const PlaneSet& target, const PlaneSet& source, const Eigen::Isometry3d& T_target_source,
    const VisibilityOptions& options = VisibilityOptions());

}  // namespace planecloud

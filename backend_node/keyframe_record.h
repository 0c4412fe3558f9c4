// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <deque>
#include <memory>
#include <vector>

#include "planecloud_slam/backend_node/map_snapshot.h"
#include "planecloud_slam/backend_node/view_sketch.h"

namespace planecloud {

/// A keyframe of the map and how far its session had come.
struct KeyframeRecord {
  std::shared_ptr<const MapKeyframe> keyframe;
  ViewSketch sketch;           ///< of what it saw
  double path = 0.0;           ///< of its session up to it, by odometry, see motionLength [m]
  std::vector<int> hinted_by;  ///< keyframes whose closure hint names this one, come before it
};

/// Whether a camera at one of the two came back to what it saw at the other: their own path between
/// them is at least `min_path_gap` [m], or they are of different sessions.
[[nodiscard]] inline bool isRevisit(const KeyframeRecord& a, const KeyframeRecord& b,
                                    double min_path_gap) {
  return !sameSession(a.keyframe->id, b.keyframe->id) || std::abs(a.path - b.path) >= min_path_gap;
}

/// All keyframes, numbered as the nodes of the pose graph.
using KeyframeRecords = std::deque<KeyframeRecord>;

}  // namespace planecloud

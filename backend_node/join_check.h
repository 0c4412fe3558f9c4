// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "planecloud_slam/backend_node/component_join.h"
#include "planecloud_slam/backend_node/keyframe_record.h"
#include "planecloud_slam/backend_node/loop_closure_options.h"
#include "planecloud_slam/backend_node/plane_set_cache.h"
#include "planecloud_slam/backend_node/pose_graph.h"
#include "planecloud_slam/icap/icap.h"

namespace planecloud {

/// Looks at what a join would imply beyond the pairs that propose it: keyframes of both components
/// that would come to see the same place must not see through each other's surfaces. Two places
/// that look alike from some spots rarely do so all along the way.
class JoinCheck {
 public:
  JoinCheck(const ClosureConsistencyOptions& options, const IcapOptions& icap)
      : options_(options), icap_(icap) {}

  /// Whether `join` holds for the keyframes within `join_check_path` of the ends of `closures`.
  [[nodiscard]] bool holds(const PoseGraph& graph, const KeyframeRecords& records,
                           const ComponentJoin& join, const std::vector<GraphEdge>& closures,
                           PlaneSetCache& plane_sets) const;

 private:
  struct Pair {
    int target = 0;
    int source = 0;
    Eigen::Isometry3d T_target_source = Eigen::Isometry3d::Identity();
  };

  [[nodiscard]] std::vector<Pair> overlappingPairs(const PoseGraph& graph,
                                                   const KeyframeRecords& records,
                                                   const ComponentJoin& join,
                                                   const std::vector<bool>& near) const;

  /// No more pairs than can be looked at, evenly chosen.
  [[nodiscard]] static std::vector<Pair> spread(const std::vector<Pair>& pairs);

  /// Share of either keyframe's tiles that the other one saw through, the larger one, [0, 1].
  [[nodiscard]] double seenThrough(const PlaneSet& target, const PlaneSet& source,
                                   const Eigen::Isometry3d& T_target_source_guess) const;

  ClosureConsistencyOptions options_;
  IcapOptions icap_;
};

}  // namespace planecloud

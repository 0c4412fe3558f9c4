// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "planecloud_slam/backend_node/loop_closure_options.h"
#include "planecloud_slam/backend_node/map_snapshot.h"
#include "planecloud_slam/backend_node/pose_graph.h"

namespace planecloud {

/// How a group of closures puts one component onto another.
struct ComponentJoin {
  int target = 0;  ///< the older component, which keeps its frame
  int source = 0;  ///< the component that moves
  Eigen::Isometry3d T_target_source =
      Eigen::Isometry3d::Identity();  ///< source's frame -> target's
};

/// The transform that fits all `closures` between two components of `graph` best (weighted by their
/// information, less what the odometry between them loses). None unless it is known to
/// `join_translation` and `join_rotation` in all directions even without any one of the closures.
[[nodiscard]] std::optional<ComponentJoin> solveComponentJoin(
    const PoseGraph& graph, const std::vector<GraphEdge>& closures,
    const ClosureConsistencyOptions& options, const DriftOptions& drift);

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <map>

#include "planecloud_slam/backend_node/map_snapshot.h"
#include "planecloud_slam/plane_fit/se3.h"

namespace planecloud {

/// Where the keyframes of a synthetic drive really are, T_world_camera.
using Truth = std::map<KeyframeId, Eigen::Isometry3d>;

/// Largest distance of a node from the truth once the first nodes coincide [m].
inline double largestError(const MapSnapshot& map, const Truth& truth) {
  const MapSnapshot::Node& first = map.nodes.front();
  const Eigen::Isometry3d T_world_map = truth.at(first.keyframe->id) * first.T_map_camera.inverse();
  double largest = 0.0;
  for (const MapSnapshot::Node& node : map.nodes) {
    const Eigen::Vector3d estimate = (T_world_map * node.T_map_camera).translation();
    largest = std::max(largest, (estimate - truth.at(node.keyframe->id).translation()).norm());
  }
  return largest;
}

/// Closures off by more than 0.1 m or 3 degrees in the directions they observe.
inline int falseClosures(const MapSnapshot& map, const Truth& truth) {
  int count = 0;
  for (const GraphEdge& edge : map.edges) {
    if (edge.kind != EdgeKind::kClosure) continue;
    const Eigen::Isometry3d T = truth.at(edge.from).inverse() * truth.at(edge.to);
    const Vector6d error = logSe3(edge.T_from_to.inverse() * T);
    const bool blind = edge.information.trace() == 0.0;
    const double weighted = error.dot(edge.information * error);
    const bool off = error.head<3>().norm() > 0.1 || error.tail<3>().norm() > 0.052;
    // Off, and not only along what the closure says nothing about.
    if (blind || (off && weighted > 30.0)) ++count;
  }
  return count;
}

}  // namespace planecloud

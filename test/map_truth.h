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

/// By how much a closure is wrong, at its end `to`: translation [m], rotation [rad].
inline Vector6d closureError(const GraphEdge& closure, const Truth& truth) {
  const Eigen::Isometry3d T = truth.at(closure.from).inverse() * truth.at(closure.to);
  return logSe3(closure.T_from_to.inverse() * T);
}

/// Whether a closure is off by more than 0.1 m or 3 degrees in the directions it observes.
inline bool isFalse(const GraphEdge& closure, const Truth& truth) {
  const Vector6d error = closureError(closure, truth);
  const bool blind = closure.information.trace() == 0.0;
  const double weighted = error.dot(closure.information * error);
  const bool off = error.head<3>().norm() > 0.1 || error.tail<3>().norm() > 0.052;
  // Off, and not only along what the closure says nothing about.
  return blind || (off && weighted > 30.0);
}

/// How many closures of the map are false.
inline int falseClosures(const MapSnapshot& map, const Truth& truth) {
  int count = 0;
  for (const GraphEdge& edge : map.edges) {
    if (edge.kind == EdgeKind::kClosure && isFalse(edge, truth)) ++count;
  }
  return count;
}

}  // namespace planecloud

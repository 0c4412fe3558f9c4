// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include "planecloud_slam/plane_fit/keyframe.h"
#include "planecloud_slam/plane_fit/se3.h"

namespace planecloud {

enum class EdgeKind {
  kOdometry,  ///< to the keyframe it was tracked from, from the frontend
  kHistory,   ///< to an earlier keyframe, from the frontend
  kClosure,   ///< found and verified by the backend
  kCoplanar,  ///< two parts of one flat surface, found by the backend; knows three directions
};

/// Whether such an edge may be found false and leave again, as what a frontend measured may not.
[[nodiscard]] constexpr bool isMadeByBackend(EdgeKind kind) {
  return kind == EdgeKind::kClosure || kind == EdgeKind::kCoplanar;
}

/// An edge of the graph as others see it.
struct GraphEdge {
  EdgeKind kind = EdgeKind::kOdometry;
  KeyframeId from;
  KeyframeId to;
  Eigen::Isometry3d T_from_to = Eigen::Isometry3d::Identity();
  Matrix6d information = Matrix6d::Zero();  ///< at `to`; see se3.h
  bool inter_robot = false;
};

}  // namespace planecloud

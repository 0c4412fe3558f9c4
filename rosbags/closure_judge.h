// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "planecloud_slam/backend_node/map_snapshot.h"
#include "planecloud_slam/rosbags/recording.h"

namespace planecloud {

/// What ground truth says of a loop closure.
enum class ClosureTruth {
  kTrue,
  kFalse,    ///< off by more than 0.1 m or 3 degrees where it claims to know
  kUnknown,  ///< one of its keyframes has no ground truth
};

/// The verdict on measured `T_from_to` against the true one. Only the directions count in which
/// `information` (tangent space at `to`) gives a standard deviation below ten times the limits:
/// a closure along a corridor may say nothing of the corridor's axis.
[[nodiscard]] ClosureTruth judgeClosure(const GraphEdge& closure,
                                        const Eigen::Isometry3d& T_from_to_truth);

/// A closure of the map and what it is worth.
struct JudgedClosure {
  GraphEdge edge;
  ClosureTruth verdict = ClosureTruth::kUnknown;
};

/// Closures of a map against ground truth.
struct ClosureJudgement {
  std::vector<JudgedClosure> closures;  ///< all closure edges; consecutive and history edges not
  std::size_t false_closures = 0;
  /// Keyframes with a partner (another robot's, or more than 10 s earlier of the same) of at least
  /// 50 % mutual view overlap.
  std::size_t possible = 0;
  std::size_t found = 0;  ///< those of them that got a true closure
};

/// A robot's name and its ground truth (empty: none).
struct RobotTruth {
  std::string robot;
  Trajectory trajectory;
};

[[nodiscard]] ClosureJudgement judgeClosures(const MapSnapshot& map,
                                             const std::vector<RobotTruth>& truths);

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "planecloud_slam/backend_node/loop_closure_options.h"
#include "planecloud_slam/backend_node/map_snapshot.h"
#include "planecloud_slam/backend_node/pose_graph.h"

namespace planecloud {

/// `closure` seen from its other end: `from` and `to` exchanged.
[[nodiscard]] GraphEdge reversed(const GraphEdge& closure);

/// Compares closures with one of them around the loop that two closures and the measurements
/// between their ends make (Mangelson et al., ICRA 2018).
class ClosureComparison {
 public:
  /// How another closure stands to this one.
  struct Result {
    double path = 0.0;         ///< between the ends, the longer of both sides [m]; may be infinite
    double distance = 0.0;     ///< squared Mahalanobis distance around the loop; 0 without a path
    bool independent = false;  ///< the two share no keyframe
  };

  /// Both ends of `closure` must be in `graph`. Paths longer than `limit` [m] count as none.
  ClosureComparison(const PoseGraph& graph, const GraphEdge& closure, const DriftOptions& drift,
                    double limit);

  [[nodiscard]] Result compare(const GraphEdge& other) const;
  /// `compare(other).path` alone, which is much cheaper.
  [[nodiscard]] double path(const GraphEdge& other) const;
  /// Positions of the closures in the graph whose path is no longer than the limit, ascending.
  [[nodiscard]] std::vector<int> neighbours() const;

 private:
  [[nodiscard]] double longerPath(const GraphEdge& other) const;
  [[nodiscard]] double loopError(const GraphEdge& other) const;

  const PoseGraph& graph_;
  GraphEdge closure_;
  DriftOptions drift_;
  double limit_;
  int from_;
  int to_;
  std::vector<double> paths_from_;  ///< from `from` to every node [m]
  std::vector<double> paths_to_;
};

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "planecloud_slam/backend_node/pose_graph.h"

namespace planecloud {

/// Poses, which of them are fixed, and measurements between them by position.
struct PoseGraphProblem {
  struct Edge {
    int from = 0;
    int to = 0;
    GraphEdge measurement;
  };
  std::vector<Eigen::Isometry3d> poses;
  std::vector<bool> fixed;  ///< same order
  std::vector<Edge> edges;
  double tolerance = 1e-8;  ///< relative decrease of the cost that is not worth another iteration
};

/// Minimises the robust sum of squared RelativePoseCost residuals over `problem.poses` (Ceres,
/// Levenberg-Marquardt, sparse Cholesky) and adds what it did to `summary`. Directions nothing
/// observes stay as they are. Poses stay untouched when the solver fails.
void solvePoseGraph(const PoseGraphOptions& options, PoseGraphProblem& problem,
                    OptimisationSummary& summary);

}  // namespace planecloud

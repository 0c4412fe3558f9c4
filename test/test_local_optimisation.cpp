// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <vector>

#include "planecloud_slam/backend_node/backend.h"
#include "planecloud_slam/backend_node/pose_graph.h"

namespace planecloud {
namespace {

KeyframeId idOf(int number) { return {"robot", 1, static_cast<std::uint32_t>(number)}; }

Eigen::Isometry3d along(double x) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation().x() = x;
  return T;
}

GraphEdge edge(int from, int to, double x, EdgeKind kind = EdgeKind::kOdometry) {
  GraphEdge result;
  result.kind = kind;
  result.from = idOf(from);
  result.to = idOf(to);
  result.T_from_to = along(x);
  result.information = Matrix6d::Identity() * 1e4;
  return result;
}

/// A line of nodes a metre apart whose odometry says 1.01 m.
PoseGraph stretchedLine(int nodes, int window) {
  PoseGraphOptions options;
  options.local_window = window;
  PoseGraph graph(options);
  for (int i = 0; i < nodes; ++i) graph.addNode(idOf(i), along(1.01 * i));
  for (int i = 1; i < nodes; ++i) graph.addEdge(edge(i - 1, i, 1.01));
  return graph;
}

double x(const PoseGraph& graph, int node) { return graph.pose(node).translation().x(); }

TEST(LocalOptimisation, MovesNothingBeyondItsWindow) {
  PoseGraph graph = stretchedLine(60, 10);
  const PoseGraph before = graph;
  graph.addEdge(edge(50, 54, 4.0, EdgeKind::kClosure));
  graph.optimizeAround({50, 54});
  int moved = 0;
  for (int i = 0; i < graph.size(); ++i) {
    const bool same = graph.pose(i).matrix() == before.pose(i).matrix();
    EXPECT_TRUE(same || (i > 44 && i < 60)) << i;
    moved += same ? 0 : 1;
  }
  EXPECT_GT(moved, 3);
  EXPECT_LE(moved, 10);
  EXPECT_LT(x(graph, 54) - x(graph, 50), 4.03) << "nearer to the closure than odometry's 4.04";
}

TEST(LocalOptimisation, IsTheWholeWhenTheWindowHoldsTheGraph) {
  PoseGraph local = stretchedLine(20, 100);
  local.addEdge(edge(0, 19, 19.0, EdgeKind::kClosure));
  PoseGraph whole = local;
  local.optimizeAround({0, 19});
  whole.optimize();
  // It stops a little earlier: tenths of a millimetre are left to the whole [m].
  for (int i = 0; i < 20; ++i) EXPECT_NEAR(x(local, i), x(whole, i), 5e-4);
}

TEST(LocalOptimisation, TakesOverWhatACopyFoundAndMovesLaterNodesAlong) {
  PoseGraph graph = stretchedLine(20, 100);
  graph.addEdge(edge(0, 19, 19.0, EdgeKind::kClosure));
  GraphOptimisation optimisation(graph);
  optimisation.run();
  const int later = graph.addNode(idOf(20), graph.pose(19) * along(1.0));
  graph.addEdge(edge(19, 20, 1.0));
  EXPECT_TRUE(graph.adopt(optimisation.graph(), optimisation.summary()).empty());
  PoseGraph whole = stretchedLine(20, 100);
  whole.addEdge(edge(0, 19, 19.0, EdgeKind::kClosure));
  whole.optimize();
  for (int i = 0; i < 20; ++i) EXPECT_NEAR(x(graph, i), x(whole, i), 1e-9);
  EXPECT_NEAR(x(graph, later), x(graph, 19) + 1.0, 1e-9);
}

TEST(LocalOptimisation, AdoptsIntoAComponentThatMovedMeanwhile) {
  PoseGraph graph = stretchedLine(20, 100);
  graph.addEdge(edge(0, 19, 19.0, EdgeKind::kClosure));
  GraphOptimisation optimisation(graph);
  optimisation.run();
  graph.moveComponent(0, along(5.0));
  static_cast<void>(graph.adopt(optimisation.graph(), optimisation.summary()));
  EXPECT_NEAR(x(graph, 0), 5.0, 1e-9);
  EXPECT_NEAR(x(graph, 19), 5.0 + x(optimisation.graph(), 19), 1e-9);
}

TEST(LocalOptimisation, TakesOutWhatTheCopyFoundFalse) {
  PoseGraph graph = stretchedLine(20, 100);
  GraphEdge lie = edge(5, 15, 3.0, EdgeKind::kClosure);
  lie.information *= 0.01;
  graph.addEdge(lie);
  GraphOptimisation optimisation(graph);
  optimisation.run();
  ASSERT_EQ(optimisation.summary().removed.size(), 1U);
  EXPECT_EQ(graph.adopt(optimisation.graph(), optimisation.summary()).size(), 1U);
  for (const GraphEdge& kept : graph.edges()) EXPECT_NE(kept.kind, EdgeKind::kClosure);
}

}  // namespace
}  // namespace planecloud

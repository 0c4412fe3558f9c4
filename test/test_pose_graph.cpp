// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>
#include <utility>
#include <vector>

#include "planecloud_slam/backend_node/pose_graph.h"

namespace planecloud {
namespace {

KeyframeId idOf(int number, const std::string& robot = "robot1") {
  return {robot, 1, static_cast<std::uint32_t>(number)};
}

GraphEdge edgeBetween(const KeyframeId& from, const KeyframeId& to, const Eigen::Isometry3d& T,
                      EdgeKind kind = EdgeKind::kOdometry) {
  GraphEdge edge;
  edge.kind = kind;
  edge.from = from;
  edge.to = to;
  edge.T_from_to = T;
  edge.information = Matrix6d::Identity() * 1e4;
  return edge;
}

/// Poses on a circle of 2 m radius, looking along the way.
std::vector<Eigen::Isometry3d> circle(int count) {
  std::vector<Eigen::Isometry3d> poses;
  for (int i = 0; i < count; ++i) {
    const double angle = 2.0 * M_PI * i / count;
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    T.translation() = 2.0 * Eigen::Vector3d(std::sin(angle), 1.0 - std::cos(angle), 0.0);
    poses.push_back(T);
  }
  return poses;
}

Vector6d noise(std::mt19937& generator, double translation, double rotation) {
  std::normal_distribution<double> normal;
  Vector6d xi;
  for (int i = 0; i < 6; ++i) xi[i] = (i < 3 ? translation : rotation) * normal(generator);
  return xi;
}

/// A loop whose initial poses come from noisy odometry, and one true closure from end to start.
PoseGraph noisyLoop(const std::vector<Eigen::Isometry3d>& truth) {
  PoseGraph graph{PoseGraphOptions()};
  std::mt19937 generator(7);
  Eigen::Isometry3d T_map_camera = truth[0];
  graph.addNode(idOf(0), T_map_camera);
  for (int i = 1; i < static_cast<int>(truth.size()); ++i) {
    const Eigen::Isometry3d T =
        truth[i - 1].inverse() * truth[i] * expSe3(noise(generator, 0.01, 0.01));
    T_map_camera = T_map_camera * T;
    graph.addNode(idOf(i), T_map_camera);
    graph.addEdge(edgeBetween(idOf(i - 1), idOf(i), T));
  }
  return graph;
}

double rmsError(const PoseGraph& graph, const std::vector<Eigen::Isometry3d>& truth) {
  double sum = 0.0;
  for (int i = 0; i < graph.size(); ++i) {
    sum += (graph.pose(i).translation() - truth[i].translation()).squaredNorm();
  }
  return std::sqrt(sum / graph.size());
}

TEST(PoseGraph, ClosesALoopOfNoisyOdometry) {
  const std::vector<Eigen::Isometry3d> truth = circle(40);
  PoseGraph graph = noisyLoop(truth);
  const double before = rmsError(graph, truth);
  for (const int i : {36, 38, 39}) {
    graph.addEdge(edgeBetween(idOf(0), idOf(i), truth[0].inverse() * truth[i], EdgeKind::kClosure));
  }
  const OptimisationSummary summary = graph.optimize();
  EXPECT_TRUE(summary.removed.empty());
  EXPECT_LT(summary.final_cost, summary.initial_cost);
  EXPECT_GT(before, 0.1);
  EXPECT_LT(rmsError(graph, truth), 0.5 * before);
}

TEST(PoseGraph, RecoversTheTruthExactlyFromExactMeasurements) {
  const std::vector<Eigen::Isometry3d> truth = circle(20);
  PoseGraph graph{PoseGraphOptions()};
  std::mt19937 generator(8);
  for (int i = 0; i < 20; ++i) {
    graph.addNode(idOf(i), i == 0 ? truth[0] : truth[i] * expSe3(noise(generator, 0.1, 0.1)));
    if (i > 0) graph.addEdge(edgeBetween(idOf(i - 1), idOf(i), truth[i - 1].inverse() * truth[i]));
  }
  graph.addEdge(edgeBetween(idOf(0), idOf(19), truth[0].inverse() * truth[19], EdgeKind::kClosure));
  graph.optimize();
  EXPECT_LT(rmsError(graph, truth), 1e-6);
}

TEST(PoseGraph, FixesTheOldestPoseOfEachComponent) {
  const std::vector<Eigen::Isometry3d> truth = circle(20);
  PoseGraph graph{PoseGraphOptions()};
  std::mt19937 generator(9);
  const Eigen::Isometry3d T_other = expSe3(noise(generator, 3.0, 1.0));
  for (int i = 0; i < 10; ++i) {
    for (const std::string robot : {"robot1", "robot2"}) {
      const Eigen::Isometry3d T_map_camera = robot == "robot1" ? truth[i] : T_other * truth[i];
      graph.addNode(idOf(i, robot), T_map_camera * expSe3(noise(generator, 0.05, 0.05)));
      if (i == 0) continue;
      graph.addEdge(
          edgeBetween(idOf(i - 1, robot), idOf(i, robot), truth[i - 1].inverse() * truth[i]));
    }
  }
  ASSERT_EQ(graph.components(), 2);
  const Eigen::Isometry3d first = graph.pose(0);
  const Eigen::Isometry3d second = graph.pose(1);
  graph.optimize();
  EXPECT_TRUE(graph.pose(0).isApprox(first, 0.0));
  EXPECT_TRUE(graph.pose(1).isApprox(second, 0.0));
  EXPECT_LT(((graph.pose(1).inverse() * graph.pose(19)).translation() -
             (truth[0].inverse() * truth[9]).translation())
                .norm(),
            1e-6);
}

TEST(PoseGraph, NumbersComponentsByTheirOldestKeyframe) {
  PoseGraph graph{PoseGraphOptions()};
  for (int i = 0; i < 4; ++i) graph.addNode(idOf(i), Eigen::Isometry3d::Identity());
  EXPECT_EQ(graph.components(), 4);
  graph.addEdge(edgeBetween(idOf(3), idOf(1), Eigen::Isometry3d::Identity()));
  EXPECT_EQ(graph.components(), 3);
  EXPECT_EQ(graph.component(1), 1);
  EXPECT_EQ(graph.component(3), 1);
  EXPECT_EQ(graph.component(2), 2);
}

TEST(PoseGraph, KeepsComponentsApartAsTheyJoinInAnyOrder) {
  PoseGraph graph{PoseGraphOptions()};
  for (int i = 0; i < 8; ++i) graph.addNode(idOf(i), Eigen::Isometry3d::Identity());
  const Eigen::Isometry3d same = Eigen::Isometry3d::Identity();
  graph.addEdge(edgeBetween(idOf(2), idOf(5), same));
  graph.addEdge(edgeBetween(idOf(7), idOf(3), same));
  graph.addEdge(edgeBetween(idOf(5), idOf(3), same));
  EXPECT_EQ(graph.components(), 5);
  EXPECT_EQ(graph.members(2), (std::vector<int>{2, 3, 5, 7}));
  EXPECT_EQ(graph.members(3), std::vector<int>{4});
  EXPECT_EQ(graph.component(6), 4);
}

TEST(PoseGraph, FindsNodesWhereTheyMovedTo) {
  PoseGraph graph{PoseGraphOptions()};
  for (int i = 0; i < 5; ++i) {
    graph.addNode(idOf(i), Eigen::Isometry3d(Eigen::Translation3d(10.0 * i, -3.0, 0.0)));
  }
  EXPECT_EQ(graph.nodesAround(1, 4.0), std::vector<int>{1});
  graph.moveComponent(4, Eigen::Isometry3d(Eigen::Translation3d(-31.0, 0.0, 0.0)));
  EXPECT_EQ(graph.nodesAround(1, 4.0), (std::vector<int>{1, 4}));
  EXPECT_EQ(graph.nodesAround(3, 4.0), std::vector<int>{3});
}

TEST(PoseGraph, LeavesADirectionNobodyObservesWhereItWas) {
  PoseGraph graph{PoseGraphOptions()};
  graph.addNode(idOf(0), Eigen::Isometry3d::Identity());
  const Eigen::Isometry3d guess(Eigen::Translation3d(1.3, 0.2, 0.1));
  graph.addNode(idOf(1), guess);
  GraphEdge edge = edgeBetween(idOf(0), idOf(1), Eigen::Isometry3d(Eigen::Translation3d(1, 0, 0)));
  edge.kind = EdgeKind::kClosure;
  edge.information.row(0).setZero();  // a corridor along x
  edge.information.col(0).setZero();
  graph.addEdge(edge);
  graph.optimize();
  EXPECT_NEAR(graph.pose(1).translation().x(), 1.3, 1e-6);
  EXPECT_NEAR(graph.pose(1).translation().y(), 0.0, 1e-6);
  EXPECT_NEAR(graph.pose(1).translation().z(), 0.0, 1e-6);
}

TEST(PoseGraph, ThrowsAFalseClosureOutAgainAndKeepsTheTrueOnes) {
  const std::vector<Eigen::Isometry3d> truth = circle(40);
  PoseGraph graph = noisyLoop(truth);
  for (const int i : {36, 37, 38, 39}) {
    graph.addEdge(edgeBetween(idOf(0), idOf(i), truth[0].inverse() * truth[i], EdgeKind::kClosure));
  }
  const Eigen::Isometry3d wrong(Eigen::Translation3d(0.0, 1.5, 0.0));
  graph.addEdge(edgeBetween(idOf(10), idOf(30), wrong, EdgeKind::kClosure));
  const OptimisationSummary summary = graph.optimize();
  ASSERT_EQ(summary.removed.size(), 1u);
  EXPECT_EQ(summary.removed[0].to, idOf(30));
  EXPECT_EQ(graph.edges().size(), 43u);
  EXPECT_LT(rmsError(graph, truth), 0.1);
}

TEST(PoseGraph, OfTwoLinksThatContradictOneGoesAndTheComponentHolds) {
  PoseGraph graph{PoseGraphOptions()};
  for (int i = 0; i < 4; ++i) graph.addNode(idOf(i), Eigen::Isometry3d::Identity());
  graph.addEdge(edgeBetween(idOf(0), idOf(1), Eigen::Isometry3d::Identity()));
  graph.addEdge(edgeBetween(idOf(2), idOf(3), Eigen::Isometry3d::Identity()));
  const Eigen::Isometry3d far(Eigen::Translation3d(4.0, 0.0, 0.0));
  graph.addEdge(edgeBetween(idOf(0), idOf(2), far, EdgeKind::kClosure));
  graph.addEdge(edgeBetween(idOf(1), idOf(3), far.inverse(), EdgeKind::kClosure));
  EXPECT_EQ(graph.components(), 1);
  EXPECT_EQ(graph.optimize().removed.size(), 1u);
  EXPECT_EQ(graph.components(), 1);
  EXPECT_EQ(graph.edges().size(), 3u);
}

TEST(PoseGraph, CoplanarEdgesHoldNoComponentTogether) {
  PoseGraph graph{PoseGraphOptions()};
  for (int i = 0; i < 4; ++i) graph.addNode(idOf(i), Eigen::Isometry3d::Identity());
  const Eigen::Isometry3d same = Eigen::Isometry3d::Identity();
  graph.addEdge(edgeBetween(idOf(0), idOf(1), same));
  graph.addEdge(edgeBetween(idOf(2), idOf(3), same));
  const Eigen::Isometry3d far(Eigen::Translation3d(4.0, 0.0, 0.0));
  graph.addEdge(edgeBetween(idOf(0), idOf(2), far, EdgeKind::kClosure));
  for (const auto& [from, to] : {std::pair(0, 2), {0, 3}, {1, 2}, {1, 3}}) {
    graph.addEdge(edgeBetween(idOf(from), idOf(to), same, EdgeKind::kCoplanar));
  }
  EXPECT_EQ(graph.coplanarEdges(), 4u);
  EXPECT_EQ(graph.closures(false), 1u);
  // All four contradict the closure, which leaves and they with it.
  EXPECT_EQ(graph.optimize().removed.size(), 1u);
  EXPECT_EQ(graph.closures(false), 0u);
  EXPECT_EQ(graph.coplanarEdges(), 0u);
  EXPECT_EQ(graph.components(), 2);
  EXPECT_EQ(graph.edges().size(), 2u);
}

TEST(PoseGraph, ThrowsAFalseCoplanarEdgeOutAgain) {
  const std::vector<Eigen::Isometry3d> truth = circle(40);
  PoseGraph graph = noisyLoop(truth);
  const Eigen::Isometry3d wrong(Eigen::Translation3d(0.0, 1.5, 0.0));
  graph.addEdge(edgeBetween(idOf(10), idOf(30), wrong, EdgeKind::kCoplanar));
  EXPECT_EQ(graph.optimize().removed.size(), 1u);
  EXPECT_EQ(graph.coplanarEdges(), 0u);
}

TEST(PoseGraph, KeepsRotationsOrthonormalHoweverOftenAComponentMoves) {
  PoseGraph graph{PoseGraphOptions()};
  std::mt19937 generator(10);
  graph.addNode(idOf(0), expSe3(noise(generator, 1.0, 1.0)));
  for (int i = 0; i < 100; ++i) {
    const Eigen::Isometry3d T = expSe3(noise(generator, 1.0, 1.0));
    graph.moveComponent(0, graph.pose(0) * T * graph.pose(0).inverse());
  }
  const Eigen::Matrix3d R = graph.pose(0).linear();
  EXPECT_LT((R.transpose() * R - Eigen::Matrix3d::Identity()).norm(), 1e-12);
}

TEST(PoseGraph, MeasuresTheShortestWayThroughCompleteMeasurements) {
  PoseGraph graph{PoseGraphOptions()};
  const Eigen::Isometry3d step(Eigen::Translation3d(1.0, 0.0, 0.0));
  for (int i = 0; i < 6; ++i) {
    graph.addNode(idOf(i), Eigen::Isometry3d::Identity());
    if (i > 0 && i < 5) graph.addEdge(edgeBetween(idOf(i - 1), idOf(i), step));
  }
  EXPECT_DOUBLE_EQ(graph.pathLengths(0)[4], 4.0);
  EXPECT_TRUE(std::isinf(graph.pathLengths(0)[5]));
  GraphEdge blind =
      edgeBetween(idOf(0), idOf(4), Eigen::Isometry3d::Identity(), EdgeKind::kClosure);
  blind.information(0, 0) = 0.0;
  graph.addEdge(blind);
  EXPECT_DOUBLE_EQ(graph.pathLengths(0)[4], 4.0);
  graph.addEdge(edgeBetween(idOf(0), idOf(3), step, EdgeKind::kClosure));
  EXPECT_DOUBLE_EQ(graph.pathLengths(0)[4], 2.0);
  EXPECT_TRUE(std::isinf(graph.pathLengths(0, 1.5)[4]));
  EXPECT_DOUBLE_EQ(graph.pathLengths(0, 1.5)[3], 1.0);
  const std::vector<double> some = graph.pathLengthsTo(0, {4, 5, 3, 4});
  EXPECT_EQ(some, (std::vector<double>{2.0, graph.pathLengths(0)[5], 1.0, 2.0}));
}

TEST(PoseGraph, RefusesEdgesWithoutTheirKeyframes) {
  PoseGraph graph{PoseGraphOptions()};
  graph.addNode(idOf(0), Eigen::Isometry3d::Identity());
  EXPECT_THROW(graph.addNode(idOf(0), Eigen::Isometry3d::Identity()), std::invalid_argument);
  const Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  EXPECT_THROW(graph.addEdge(edgeBetween(idOf(0), idOf(1), T)), std::invalid_argument);
  EXPECT_THROW(graph.addEdge(edgeBetween(idOf(0), idOf(0), T)), std::invalid_argument);
}

}  // namespace
}  // namespace planecloud

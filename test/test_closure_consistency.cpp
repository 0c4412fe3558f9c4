// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "planecloud_slam/backend_node/closure_consistency.h"
#include "planecloud_slam/backend_node/consistent_group.h"

namespace planecloud {
namespace {

KeyframeId idOf(const std::string& robot, int number) {
  return {robot, 1, static_cast<std::uint32_t>(number)};
}

Eigen::Isometry3d along(double x, double y = 0.0) {
  return Eigen::Isometry3d(Eigen::Translation3d(x, y, 0.0));
}

GraphEdge closureBetween(const KeyframeId& from, const KeyframeId& to, const Eigen::Isometry3d& T) {
  GraphEdge edge;
  edge.kind = EdgeKind::kClosure;
  edge.from = from;
  edge.to = to;
  edge.T_from_to = T;
  edge.information = Matrix6d::Identity() * 2500.0;  // 2 cm, 0.02 rad
  return edge;
}

/// Two robots on straight ways of ten keyframes, half a metre apart; b's true way lies 1 m beside
/// a's, but its component has a frame of its own.
class ClosureConsistencyTest : public testing::Test {
 protected:
  ClosureConsistencyTest() {
    for (int i = 0; i < 10; ++i) addKeyframe("a", i);
    for (int i = 0; i < 10; ++i) addKeyframe("b", i);
  }

  void addKeyframe(const std::string& robot, int i) {
    graph_.addNode(idOf(robot, i), along(0.5 * i));
    if (i == 0) return;
    GraphEdge step = closureBetween(idOf(robot, i - 1), idOf(robot, i), along(0.5));
    step.kind = EdgeKind::kOdometry;
    graph_.addEdge(step);
  }

  ClosureAdmission offer(const GraphEdge& closure, bool holds = true) {
    return consistency_.offer(graph_, closure, [&](const auto&, const auto&) { return holds; });
  }

  /// Offers true closures between a/i and b/i for i in [first, last); the last answer.
  ClosureAdmission offerTrue(int first, int last, bool holds = true) {
    ClosureAdmission admission;
    for (int i = first; i < last; ++i) {
      admission = offer(closureBetween(idOf("a", i), idOf("b", i), along(0.0, 1.0)), holds);
    }
    return admission;
  }

  PoseGraph graph_{PoseGraphOptions()};
  ClosureConsistency consistency_{ClosureConsistencyOptions(), DriftOptions()};
};

TEST_F(ClosureConsistencyTest, JoinsComponentsOnlyByAGroup) {
  EXPECT_TRUE(offerTrue(0, 3).closures.empty());
  const ClosureAdmission admission = offerTrue(3, 4);
  EXPECT_EQ(admission.closures.size(), 4u);
  ASSERT_TRUE(admission.join.has_value());
  EXPECT_EQ(admission.join->target, 0);
  EXPECT_EQ(admission.join->source, 1);
  EXPECT_LT((admission.join->T_target_source.translation() - Eigen::Vector3d(0.0, 1.0, 0.0)).norm(),
            1e-6);
}

TEST_F(ClosureConsistencyTest, JoinsAsWellWhenClosuresPointTheOtherWay) {
  ClosureAdmission admission;
  for (int i = 0; i < 4; ++i) {
    const GraphEdge closure = closureBetween(idOf("a", i), idOf("b", i), along(0.0, 1.0));
    admission = offer(i % 2 == 0 ? closure : reversed(closure));
  }
  ASSERT_TRUE(admission.join.has_value());
  EXPECT_LT((admission.join->T_target_source.translation() - Eigen::Vector3d(0.0, 1.0, 0.0)).norm(),
            1e-6);
}

TEST_F(ClosureConsistencyTest, LeavesClosuresOutThatTheGroupContradicts) {
  for (int i = 0; i < 2; ++i) {
    EXPECT_TRUE(offer(closureBetween(idOf("a", i), idOf("b", 9 - i), along(3.0, -2.0 * i)))
                    .closures.empty());
  }
  const ClosureAdmission admission = offerTrue(0, 4);
  EXPECT_EQ(admission.closures.size(), 4u);
  EXPECT_EQ(admission.rejected.size(), 2u);
}

TEST_F(ClosureConsistencyTest, WaitsWhileTwoGroupsContradictEachOther) {
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(
        offer(closureBetween(idOf("a", i), idOf("b", i), along(2.5, 1.0))).closures.empty());
  }
  EXPECT_TRUE(offerTrue(4, 9).closures.empty());
  EXPECT_EQ(offerTrue(9, 10).closures.size(), 6u);
}

TEST_F(ClosureConsistencyTest, CountsClosuresThatShareAKeyframeOnce) {
  ClosureAdmission admission;
  for (int i = 0; i < 8; ++i) {
    admission = offer(closureBetween(idOf("a", 0), idOf("b", i), along(0.5 * i, 1.0)));
    EXPECT_TRUE(admission.closures.empty());
  }
}

TEST_F(ClosureConsistencyTest, DoesNotJoinAlongADirectionNobodyObserves) {
  for (int i = 0; i < 8; ++i) {
    GraphEdge corridor = closureBetween(idOf("a", i), idOf("b", i), along(0.0, 1.0));
    corridor.information.row(0).setZero();
    corridor.information.col(0).setZero();
    EXPECT_TRUE(offer(corridor).closures.empty());
  }
  // One witness for the missing direction is none: it could be the false one.
  EXPECT_TRUE(offerTrue(8, 9).closures.empty());
  EXPECT_TRUE(offerTrue(9, 10).join.has_value());
}

TEST_F(ClosureConsistencyTest, LeavesOutPiecesOfACorridorOutOfSightOfEachOther) {
  const auto corridor = [](int i, double x) {
    GraphEdge closure = closureBetween(idOf("a", i), idOf("b", i), along(x, 1.0));
    closure.information.row(0).setZero();
    closure.information.col(0).setZero();
    return closure;
  };
  // Planes say nothing against either: only the first is near enough to see what its partner saw.
  EXPECT_TRUE(offer(corridor(8, 1.0)).closures.empty());
  EXPECT_TRUE(offer(corridor(6, 14.0)).closures.empty());
  EXPECT_TRUE(offer(corridor(7, 14.0)).closures.empty());
  const ClosureAdmission admission = offerTrue(0, 3);
  ASSERT_TRUE(admission.join.has_value());
  EXPECT_EQ(admission.closures.size(), 4u);
  EXPECT_EQ(admission.rejected.size(), 2u);
}

TEST_F(ClosureConsistencyTest, LetsTheJudgeForbidAJoin) {
  EXPECT_TRUE(offerTrue(0, 6, false).closures.empty());
  EXPECT_TRUE(offerTrue(6, 7, true).join.has_value());
}

TEST_F(ClosureConsistencyTest, WantsANeighbourToVouchInsideAComponent) {
  EXPECT_TRUE(offer(closureBetween(idOf("a", 0), idOf("a", 8), along(4.0))).closures.empty());
  EXPECT_TRUE(offer(closureBetween(idOf("a", 0), idOf("a", 9), along(5.5))).closures.empty());
  const ClosureAdmission admission = offer(closureBetween(idOf("a", 1), idOf("a", 9), along(4.0)));
  ASSERT_EQ(admission.closures.size(), 2u);
  EXPECT_EQ(admission.closures[0].to, idOf("a", 8));
  EXPECT_FALSE(admission.join.has_value());
}

TEST_F(ClosureConsistencyTest, RejectsWhatContradictsTheClosuresOfTheGraph) {
  graph_.addEdge(closureBetween(idOf("a", 0), idOf("a", 8), along(4.0)));
  const ClosureAdmission admission = offer(closureBetween(idOf("a", 1), idOf("a", 9), along(4.6)));
  EXPECT_TRUE(admission.closures.empty());
  EXPECT_EQ(admission.rejected.size(), 1u);
  EXPECT_EQ(offer(closureBetween(idOf("a", 1), idOf("a", 9), along(4.0))).closures.size(), 1u);
}

TEST(LargestConsistentGroup, FindsTheClique) {
  ConsistencyMatrix agrees(6, std::vector<bool>(6, false));
  const auto link = [&](std::size_t i, std::size_t j) { agrees[i][j] = agrees[j][i] = true; };
  link(1, 3);
  link(1, 5);
  link(3, 5);
  link(0, 1);
  link(0, 2);
  EXPECT_EQ(largestConsistentGroup(agrees), (std::vector<std::size_t>{1, 3, 5}));
  EXPECT_TRUE(largestConsistentGroup({}).empty());
}

}  // namespace
}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "planecloud_slam/plane_fit/se3.h"
#include "planecloud_slam/rosbags/closure_judge.h"
#include "room_map.h"

namespace planecloud {
namespace {

constexpr double kDegree = M_PI / 180.0;

Eigen::Isometry3d pose(double x, double y, double z, double turn) {
  Vector6d xi = Vector6d::Zero();
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  xi(4) = turn;
  T.linear() = expSe3(xi).linear();
  T.translation() << x, y, z;
  return T;
}

GraphEdge closure(const Eigen::Isometry3d& T_from_to, const Matrix6d& information) {
  GraphEdge edge;
  edge.kind = EdgeKind::kClosure;
  edge.from = {"robot1", 1, 0};
  edge.to = {"robot1", 1, 2};
  edge.T_from_to = T_from_to;
  edge.information = information;
  return edge;
}

const Matrix6d kPrecise = 1e4 * Matrix6d::Identity();  // 1 cm, 0.6 degrees

TEST(ClosureJudge, AllowsTenCentimetresAndThreeDegrees) {
  const Eigen::Isometry3d T = pose(1.0, 0.2, -0.5, 0.7);
  EXPECT_EQ(judgeClosure(closure(T * pose(0.09, 0, 0, 0), kPrecise), T), ClosureTruth::kTrue);
  EXPECT_EQ(judgeClosure(closure(T * pose(0.11, 0, 0, 0), kPrecise), T), ClosureTruth::kFalse);
  EXPECT_EQ(judgeClosure(closure(T * pose(0, 0, 0, 2.9 * kDegree), kPrecise), T),
            ClosureTruth::kTrue);
  EXPECT_EQ(judgeClosure(closure(T * pose(0, 0, 0, 3.1 * kDegree), kPrecise), T),
            ClosureTruth::kFalse);
}

TEST(ClosureJudge, ForgivesWhatAClosureDoesNotClaimToKnow) {
  const Eigen::Isometry3d T = pose(1.0, 0.2, -0.5, 0.7);
  Matrix6d corridor = kPrecise;  // runs along z of the camera at `to`
  corridor.row(2).setZero();
  corridor.col(2).setZero();
  const Eigen::Isometry3d slid = T * pose(0, 0, 4.0, 0);
  EXPECT_EQ(judgeClosure(closure(slid, kPrecise), T), ClosureTruth::kFalse);
  EXPECT_EQ(judgeClosure(closure(slid, corridor), T), ClosureTruth::kTrue);
  EXPECT_EQ(judgeClosure(closure(slid * pose(0.2, 0, 0, 0), corridor), T), ClosureTruth::kFalse);
}

TEST(ClosureJudge, ALongSlideDoesNotTurnASmallRotationIntoAFault) {
  const Eigen::Isometry3d T = pose(0.0, 0.0, 0.0, 0.0);
  Matrix6d corridor = kPrecise;
  corridor.row(2).setZero();
  corridor.col(2).setZero();
  EXPECT_EQ(
      judgeClosure(closure(T * pose(0, 0, 6.0, 0) * pose(0, 0, 0, -2.0 * kDegree), corridor), T),
      ClosureTruth::kFalse)
      << "6 m at 2 degrees are 21 cm across at the keyframe's own place";
  EXPECT_EQ(judgeClosure(closure(T * pose(0, 0, 6.0, 0), corridor), T), ClosureTruth::kTrue);
}

/// A robot that sees a wall, turns away from it and sees it again a minute later.
class ClosureJudgementTest : public testing::Test {
 protected:
  ClosureJudgementTest() {
    add("robot1", 0, 0.0, levelCamera(0.0, 0.0, 0.0));
    add("robot1", 1, 30.0, levelCamera(0.0, 0.0, 3.0));
    add("robot1", 2, 60.0, levelCamera(0.1, 0.05, 0.05));
  }

  void add(const std::string& robot, std::uint32_t number, double stamp,
           const Eigen::Isometry3d& T_world_camera) {
    // The map has a frame of its own.
    const Eigen::Isometry3d T_map_world = pose(5.0, 1.0, 0.0, 1.0);
    addKeyframe(map_, {robot, 1, number}, stamp, T_map_world * T_world_camera, wallAndFloor(2.0));
    auto truth = truths_.begin();
    while (truth != truths_.end() && truth->robot != robot) ++truth;
    if (truth == truths_.end()) truth = truths_.insert(truth, {robot, {}});
    truth->trajectory.push_back({stamp, T_world_camera});
  }

  void close(const Eigen::Isometry3d& T_error, EdgeKind kind = EdgeKind::kClosure) {
    const Eigen::Isometry3d T_from_to =
        levelCamera(0.0, 0.0, 0.0).inverse() * levelCamera(0.1, 0.05, 0.05) * T_error;
    GraphEdge edge = closure(T_from_to, kPrecise);
    edge.kind = kind;
    map_.edges.push_back(edge);
  }

  MapSnapshot map_;
  std::vector<RobotTruth> truths_;
};

TEST_F(ClosureJudgementTest, FindsTheKeyframesThatCouldBeClosed) {
  const ClosureJudgement judgement = judgeClosures(map_, truths_);
  EXPECT_EQ(judgement.possible, 1U);  // only the later one has a partner earlier on its path
  EXPECT_EQ(judgement.found, 0U);
}

TEST_F(ClosureJudgementTest, CountsTrueAndFalseClosures) {
  close(Eigen::Isometry3d::Identity());
  ClosureJudgement judgement = judgeClosures(map_, truths_);
  EXPECT_EQ(judgement.found, 1U);
  EXPECT_EQ(judgement.false_closures, 0U);
  map_.edges = {};
  close(pose(0.3, 0, 0, 0));
  judgement = judgeClosures(map_, truths_);
  EXPECT_EQ(judgement.found, 0U);
  EXPECT_EQ(judgement.false_closures, 1U);
}

TEST_F(ClosureJudgementTest, ConsecutiveAndHistoryEdgesDoNotCount) {
  close(Eigen::Isometry3d::Identity(), EdgeKind::kHistory);
  const ClosureJudgement judgement = judgeClosures(map_, truths_);
  EXPECT_TRUE(judgement.closures.empty());
  EXPECT_EQ(judgement.found, 0U);
}

TEST_F(ClosureJudgementTest, AnotherRobotIsAPartnerAtAnyTimeAndBothCount) {
  add("robot2", 0, 0.5, levelCamera(0.05, 0.0, 0.0));
  EXPECT_EQ(judgeClosures(map_, truths_).possible, 3U);  // robot1's first and last, robot2's
}

TEST_F(ClosureJudgementTest, WithoutGroundTruthNothingIsJudged) {
  close(pose(0.3, 0, 0, 0));
  const ClosureJudgement judgement = judgeClosures(map_, {});
  ASSERT_EQ(judgement.closures.size(), 1U);
  EXPECT_EQ(judgement.closures[0].verdict, ClosureTruth::kUnknown);
  EXPECT_EQ(judgement.false_closures, 0U);
  EXPECT_EQ(judgement.possible, 0U);
}

}  // namespace
}  // namespace planecloud

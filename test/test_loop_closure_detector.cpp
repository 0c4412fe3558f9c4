// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "planecloud_slam/backend_node/keyframe_map.h"
#include "planecloud_slam/backend_node/loop_closure_detector.h"
#include "synthetic_planes.h"

namespace planecloud {
namespace {

/// A map of keyframes with exact edges in one room.
class LoopClosureDetectorTest : public testing::Test {
 protected:
  /// Adds the next keyframe of `robot`; the first one of a robot has no edge.
  int add(const std::string& robot, const Eigen::Isometry3d& T_world_camera,
          std::vector<KeyframeId> hints = {}) {
    Keyframe keyframe;
    keyframe.id = {robot, 1, static_cast<std::uint32_t>(counts_[robot]++)};
    keyframe.T_odom_camera = T_world_camera;
    keyframe.closure_hints = std::move(hints);
    if (keyframe.id.number > 0) {
      RelativePoseEdge edge;
      edge.other = {robot, 1, keyframe.id.number - 1};
      edge.T_other_this = last_[robot].inverse() * T_world_camera;
      edge.information *= 1e4;
      keyframe.edges.push_back(edge);
    }
    last_[robot] = T_world_camera;
    const PlaneCloud planes = makeRoom().view(T_world_camera, 0.0, 1);
    return map_.add(std::move(keyframe), planes);
  }

  std::vector<int> targets(int source, const LoopCandidateOptions& options = {}) {
    LoopClosureDetector detector(options, DriftOptions());
    std::vector<int> result;
    for (const LoopCandidate& candidate : detector.detect(map_.graph(), map_.records(), source)) {
      EXPECT_EQ(candidate.source, source);
      result.push_back(candidate.target);
    }
    return result;
  }

  static Eigen::Isometry3d at(double x, double yaw = 0.0) {
    return lookAlongX({x, 0.0, 0.8}, yaw, 0.1);
  }

  KeyframeMap map_{PoseGraphOptions(), MapFrameOptions()};
  std::map<std::string, int> counts_;
  std::map<std::string, Eigen::Isometry3d> last_;
};

TEST_F(LoopClosureDetectorTest, ProposesAPlaceSeenBeforeButNotTheWayJustGone) {
  const int start = add("a", at(-2.0));
  for (const double x : {-1.0, 0.0, -1.0}) add("a", at(x));
  const int back = add("a", at(-1.9));
  const std::vector<int> found = targets(back);
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found.front(), start);
  EXPECT_EQ(std::count(found.begin(), found.end(), back - 1), 0);
}

TEST_F(LoopClosureDetectorTest, DoesNotProposeTheSamePlaceSeenTheOtherWay) {
  add("a", at(-1.0));
  add("a", at(1.0));
  const int turned = add("a", at(-1.0, 3.0));
  EXPECT_TRUE(targets(turned).empty());
}

TEST_F(LoopClosureDetectorTest, FollowsHintsIntoOtherComponents) {
  add("a", at(-2.0));
  const int hinted = add("a", at(-1.5));
  const int lone = add("b", at(-1.5), {{"a", 1, 1}, {"a", 1, 99}});
  EXPECT_EQ(targets(lone), std::vector<int>{hinted});
}

TEST_F(LoopClosureDetectorTest, RemembersHintsAtKeyframesStillUnderWay) {
  const int early = add("a", at(-2.0), {{"b", 1, 1}, {"c", 1, 0}});
  add("b", at(1.0));
  const int hinted = add("b", at(-1.9));
  EXPECT_EQ(targets(hinted), std::vector<int>{early});
}

TEST_F(LoopClosureDetectorTest, ProposesNoMoreThanItMay) {
  for (int i = 0; i < 5; ++i) add("a", at(-2.0 + 0.05 * i));
  for (const double x : {1.0, -1.0}) add("a", at(x));
  const int back = add("a", at(-1.95));
  LoopCandidateOptions options;
  options.max_spatial = 2;
  EXPECT_EQ(targets(back, options).size(), 2u);
  options.max_spatial = 0;
  EXPECT_TRUE(targets(back, options).empty());
}

}  // namespace
}  // namespace planecloud

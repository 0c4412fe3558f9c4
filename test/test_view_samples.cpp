// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "planecloud_slam/rosbags/view_samples.h"
#include "room_map.h"

namespace planecloud {
namespace {

double sharedBy(const Eigen::Isometry3d& T_a_b) {
  const ViewSamples view(wallAndFloor(2.0));
  return view.shareSeenBy(view, T_a_b);
}

Eigen::Isometry3d moveAndTurn(double right, double turn) {
  return levelCamera(0.0, 0.0, 0.0).inverse() * levelCamera(0.0, -right, turn);
}

TEST(ViewSamples, AViewSharesAllWithItself) {
  EXPECT_DOUBLE_EQ(sharedBy(Eigen::Isometry3d::Identity()), 1.0);
}

TEST(ViewSamples, AStepAsideSharesWhatStaysInTheImage) {
  // The image is 2.3 m wide at the wall, 2 m ahead.
  EXPECT_GT(sharedBy(moveAndTurn(0.4, 0.0)), 0.7);
  EXPECT_LT(sharedBy(moveAndTurn(1.8, 0.0)), 0.3);
}

TEST(ViewSamples, LookingAwaySharesNothing) {
  EXPECT_DOUBLE_EQ(sharedBy(moveAndTurn(0.0, M_PI)), 0.0);
}

TEST(ViewSamples, AnotherDepthIsAnotherThing) {
  const ViewSamples near(wallAndFloor(2.0));
  const ViewSamples far(wallAndFloor(3.0));
  EXPECT_LT(near.shareSeenBy(far, Eigen::Isometry3d::Identity()), 0.5);
}

TEST(ViewSamples, AnEmptyCloudSharesNothing) {
  PlaneCloud empty = wallAndFloor(2.0);
  empty.tiles.clear();
  const ViewSamples view{empty};
  EXPECT_DOUBLE_EQ(view.shareSeenBy(view, Eigen::Isometry3d::Identity()), 0.0);
}

}  // namespace
}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "planecloud_slam/frontend_node/planar_motion.h"
#include "synthetic_scene.h"

namespace planecloud {
namespace {

using synthetic::pose;

/// A camera that looks 20 degrees down and is rolled a little, 0.4 m above a floor whose up is z.
const Eigen::Isometry3d kMount = pose(0.1, -0.05, 0.4, -1.9, 0.1, 0.05);
const Eigen::Vector3d kUp = kMount.linear().transpose() * Eigen::Vector3d::UnitZ();

/// Motion of the camera when its base moves on the floor.
Eigen::Isometry3d drive(double x, double y, double yaw) {
  return kMount.inverse() * pose(x, y, 0, 0, 0, yaw) * kMount;
}

TEST(PlanarMotion, LeavesMotionsOnTheFloorAsTheyAre) {
  for (const double yaw : {-3.0, -0.5, 0.0, 0.7, 2.0}) {
    const Eigen::Isometry3d T = drive(0.3, -0.7, yaw);
    EXPECT_TRUE(PlanarMotion(kUp).nearest(T).isApprox(T, 1e-12)) << yaw;
  }
}

TEST(PlanarMotion, TakesOutHeightRollAndPitch) {
  const Eigen::Isometry3d T = drive(0.3, -0.7, 0.4);
  const Eigen::Isometry3d lifted = kMount.inverse() * pose(0, 0, 0.03) * kMount * T;
  EXPECT_TRUE(PlanarMotion(kUp).nearest(lifted).isApprox(T, 1e-12));
  const Eigen::Isometry3d tilted = T * pose(0, 0, 0, 0.02, 0.0, 0.0);
  const Eigen::Isometry3d nearest = PlanarMotion(kUp).nearest(tilted);
  EXPECT_TRUE((nearest.linear() * kUp).isApprox(kUp, 1e-12));
  EXPECT_LT(rotationAngle(nearest.inverse() * T), 0.02);
}

TEST(PlanarMotion, StepsAlongItsBasisStayOnTheFloor) {
  const PlanarMotion planar(kUp);
  const Eigen::Isometry3d T = drive(1.0, 0.5, 1.2);
  const Vector6d step = planar.basis() * Eigen::Vector3d(0.2, -0.1, 0.3);
  const Eigen::Isometry3d moved = T * expSe3(step);
  EXPECT_TRUE(planar.nearest(moved).isApprox(moved, 1e-12));
}

TEST(PlanarMotion, KnowsWhatTheBasisLeavesOut) {
  const PlanarMotion planar(kUp);
  const Matrix6d information = planar.information();
  EXPECT_LT((information * planar.basis()).norm(), 1e-6);
  Eigen::Matrix<double, 6, 1> lifted;
  lifted << 0.01 * kUp, Eigen::Vector3d::Zero();
  EXPECT_NEAR(lifted.dot(information * lifted), 4.0, 1e-6);  // 1 cm is two standard deviations
}

}  // namespace
}  // namespace planecloud

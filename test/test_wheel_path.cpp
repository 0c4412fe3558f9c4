// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "planecloud_slam/frontend_node/wheel_path.h"

namespace planecloud {
namespace {

Eigen::Isometry3d step(double forwards, double turn) {
  return Eigen::Translation3d(0.0, 0.0, forwards) *
         Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitY());
}

TEST(WheelPath, IsWorthLessTheFartherItGoesEvenBackToWhereItBegan) {
  WheelPath path;
  for (int i = 0; i < 100; ++i) path.add(step(0.1, 0.02));
  for (int i = 0; i < 100; ++i) path.add(step(-0.1, -0.02));
  const Matrix6d covariance = path.information().inverse();
  // 20 m and 4 rad were driven, of which up to 5 % slipped.
  for (int i = 0; i < 3; ++i) EXPECT_GE(covariance(i, i), 1.0);
  for (int i = 3; i < 6; ++i) EXPECT_GE(covariance(i, i), 0.04);
}

TEST(WheelPath, IsNotTrustedBlindlyWhileTheyStandStill) {
  WheelPath path;
  path.add(Eigen::Isometry3d::Identity());
  EXPECT_LT(path.information().maxCoeff(), 1e4);
  EXPECT_GT(path.information().diagonal().minCoeff(), 1e2);
}

}  // namespace
}  // namespace planecloud

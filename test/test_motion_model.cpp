// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>

#include "planecloud_slam/frontend_node/motion_model.h"
#include "synthetic_scene.h"

namespace planecloud {
namespace {

using synthetic::pose;

const Eigen::Isometry3d kMotion = pose(0.02, 0.0, 0.03, 0.0, 0.05, 0.0);  // within 0.1 s

TEST(MotionModel, GoesOnAtConstantVelocityForwardsAndBackwards) {
  MotionModel model;
  EXPECT_FALSE(model.after(1.0));
  model.observe(kMotion, 0.1);
  EXPECT_TRUE(model.after(0.2)->isApprox(kMotion * kMotion, 1e-12));
  EXPECT_TRUE(model.after(-0.1)->isApprox(kMotion.inverse(), 1e-12));
}

TEST(MotionModel, AfterALossNothingIsPredictedButTheOldMotionIsPossible) {
  MotionModel model;
  model.observe(kMotion, 0.1);
  model.forget();
  EXPECT_FALSE(model.after(0.1));
  const std::vector<Eigen::Isometry3d> motions = model.possibleMotions(0.1);
  EXPECT_TRUE(std::any_of(motions.begin(), motions.end(),
                          [](const Eigen::Isometry3d& T) { return T.isApprox(kMotion, 1e-12); }));
}

}  // namespace
}  // namespace planecloud

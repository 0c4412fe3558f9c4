// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <limits>

#include "expect_error.h"
#include "planecloud_slam/plane_fit/se3.h"
#include "planecloud_slam/planecloud_msgs/pose_conversions.h"

namespace planecloud {
namespace {

Eigen::Isometry3d somePose() {
  Vector6d xi;
  xi << 1.0, -2.0, 0.3, 0.4, -1.7, 2.1;
  return expSe3(xi);
}

TEST(PoseConversions, GiveThePoseBack) {
  EXPECT_TRUE(fromMessage(toPoseMessage(somePose())).isApprox(somePose(), 1e-12));
  EXPECT_TRUE(fromMessage(toTransformMessage(somePose())).isApprox(somePose(), 1e-12));
}

TEST(PoseConversions, NormaliseQuaternionsOfFewDigits) {
  geometry_msgs::Pose pose = toPoseMessage(somePose());
  pose.orientation.w *= 1.001;
  EXPECT_TRUE(fromMessage(pose).linear().isUnitary(1e-12));
}

TEST(PoseConversions, RefuseWhatIsNoPose) {
  expectError<MessageError>([] { static_cast<void>(fromMessage(geometry_msgs::Pose())); },
                            {"quaternion of norm 0"});
  geometry_msgs::Transform transform = toTransformMessage(somePose());
  transform.translation.y = std::numeric_limits<double>::quiet_NaN();
  expectError<MessageError>([&] { static_cast<void>(fromMessage(transform)); }, {"not finite"});
}

}  // namespace
}  // namespace planecloud

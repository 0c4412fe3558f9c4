// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>

#include "planecloud_slam/plane_fit/keyframe_rounding.h"

namespace planecloud {
namespace {

Keyframe someKeyframe() {
  Vector6d xi;
  xi << 1.23456789, -20.1, 0.3, 0.4, -1.7, 2.1;
  Keyframe keyframe;
  keyframe.id = {"robot1", 17, 4};
  keyframe.stamp = 1305031102.160407;
  keyframe.T_odom_camera = expSe3(xi);
  keyframe.planes.camera = {640, 480, 517.3, 516.5, 318.6, 255.3, {0.2624, -0.9531, 0, 0, 1}};
  RelativePoseEdge edge;
  edge.other = {"robot1", 17, 3};
  edge.T_other_this = expSe3(0.1 * xi);
  const Matrix6d root = Matrix6d::Random();
  edge.information = 1e5 * root.transpose() * root;
  keyframe.edges.push_back(edge);
  return keyframe;
}

TEST(KeyframeRounding, MovesAPoseByLessThanTenMicrometres) {
  const Keyframe keyframe = someKeyframe();
  const Keyframe travelled = asTravelled(keyframe);
  // Single precision has steps of 2e-6 m at 20 m and 2e-7 rad at 3 rad.
  const Vector6d xi = logSe3(keyframe.T_odom_camera.inverse() * travelled.T_odom_camera);
  EXPECT_LT(xi.norm(), 1e-5);
  EXPECT_GT(xi.norm(), 0.0);
}

TEST(KeyframeRounding, KeepsTheInformationSymmetricAndClose) {
  const Keyframe keyframe = someKeyframe();
  const Matrix6d information = asTravelled(keyframe).edges[0].information;
  EXPECT_EQ(information, Matrix6d(information.transpose()));
  EXPECT_TRUE(information.isApprox(keyframe.edges[0].information, 1e-6));
}

TEST(KeyframeRounding, KeepsStampsToTheNanosecond) {
  EXPECT_NEAR(asTravelled(someKeyframe()).stamp, 1305031102.160407, 3e-7);  // one double step
  EXPECT_DOUBLE_EQ(roundStamp(0.1234567894), 0.123456789);
}

TEST(KeyframeRounding, IsDoneAfterTheFirstTime) {
  const Keyframe once = asTravelled(someKeyframe());
  EXPECT_EQ(roundCamera(once.planes.camera), once.planes.camera);
  EXPECT_EQ(roundStamp(once.stamp), once.stamp);
  EXPECT_EQ(packInformation(once.edges[0].information),
            packInformation(asTravelled(once).edges[0].information));
  EXPECT_LT(logSe3(once.T_odom_camera.inverse() * asTravelled(once).T_odom_camera).norm(), 1e-5);
}

TEST(KeyframeRounding, KeepsStatisticsToTheirStepAndFlagsExactly) {
  Keyframe keyframe = someKeyframe();
  keyframe.planes.statistics = {0.98765, 0.0027123, 0.0131, 0.01234, true, true};
  const PlaneCloudStatistics statistics = asTravelled(keyframe).planes.statistics;
  EXPECT_NEAR(statistics.coverage, 0.98765, 0.5e-4);           // half a step
  EXPECT_NEAR(statistics.point_plane_error, 0.0027123, 5e-6);  // half a step
  EXPECT_NEAR(statistics.depth_error, 0.0131, 5e-6);           // half a step
  EXPECT_NEAR(statistics.fit_time, 0.01234, 5e-5);             // half a step
  EXPECT_TRUE(statistics.stopped_by_time && statistics.stopped_by_bytes);
}

TEST(KeyframeRounding, SaturatesStatisticsOutOfRange) {
  const PackedStatistics packed = packStatistics({1.5, 1e9, -1.0, std::nan(""), false, false});
  EXPECT_EQ(packed.coverage, 10000);
  EXPECT_EQ(packed.point_plane_error, 65535);
  EXPECT_EQ(packed.depth_error, 0);
  EXPECT_EQ(packed.fit_time, 0);
}

}  // namespace
}  // namespace planecloud

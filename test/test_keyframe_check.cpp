// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>

#include "planecloud_slam/backend_node/keyframe_check.h"
#include "planecloud_slam/plane_fit/plane_cloud_codec.h"
#include "synthetic_planes.h"

namespace planecloud {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Keyframe sound() {
  Keyframe keyframe;
  keyframe.id = {"robot1", 7, 3};
  keyframe.stamp = 12.5;
  keyframe.planes =
      encode(makeRoom().view(lookAlongX({-2.0, 0.0, 0.8}, 0.0, 0.1), 0.0, 1), CodecOptions());
  RelativePoseEdge edge;
  edge.other = {"robot1", 7, 2};
  keyframe.edges.push_back(edge);
  edge.other = {"robot1", 7, 0};
  edge.information(0, 0) = 0.0;
  keyframe.edges.push_back(edge);
  return keyframe;
}

struct Fault {
  std::string expected;  ///< part of the reason
  std::function<void(Keyframe&)> make;
};

TEST(KeyframeCheck, PassesASoundKeyframeAndDecodesItsPlanes) {
  const Keyframe keyframe = sound();
  const KeyframeCheck check = checkKeyframe(keyframe);
  EXPECT_EQ(check.reason, "");
  ASSERT_TRUE(check.planes);
  EXPECT_EQ(check.planes->tiles.size(), keyframe.planes.plane_count);
}

TEST(KeyframeCheck, RefusesEachFaultWithItsReason) {
  const std::vector<Fault> faults{
      {"no name", [](Keyframe& k) { k.id.robot.clear(); }},
      {"stamp", [](Keyframe& k) { k.stamp = kNan; }},
      {"stamp", [](Keyframe& k) { k.stamp = -1.0; }},
      {"odometry pose", [](Keyframe& k) { k.T_odom_camera.translation().x() = kNan; }},
      {"odometry pose", [](Keyframe& k) { k.T_odom_camera.linear() *= 1.01; }},
      {"odometry pose", [](Keyframe& k) { k.T_odom_camera.linear().row(0) *= -1.0; }},
      {"odometry pose", [](Keyframe& k) { k.T_odom_camera.translation().x() = 1e30; }},
      {"edge to robot1/7/2: the pose",
       [](Keyframe& k) { k.edges[0].T_other_this.translation().y() = kNan; }},
      {"to itself", [](Keyframe& k) { k.edges[0].other = k.id; }},
      {"a later one", [](Keyframe& k) { k.edges[0].other.number = 9; }},
      {"twice", [](Keyframe& k) { k.edges[1].other = k.edges[0].other; }},
      {"the information", [](Keyframe& k) { k.edges[0].information(1, 1) = kNan; }},
      {"the information", [](Keyframe& k) { k.edges[0].information(1, 2) = 0.5; }},
      {"the information", [](Keyframe& k) { k.edges[0].information(1, 1) = -1.0; }},
      {"cannot be decoded", [](Keyframe& k) { k.planes.bytes.clear(); }},
      {"cannot be decoded", [](Keyframe& k) { k.planes.bytes[0] = 99; }},
      {"cannot be decoded", [](Keyframe& k) { k.planes.plane_count = 4000000000U; }},
      {"cannot be decoded", [](Keyframe& k) { k.planes.camera.width = -3; }},
  };
  for (const Fault& fault : faults) {
    Keyframe keyframe = sound();
    fault.make(keyframe);
    const KeyframeCheck check = checkKeyframe(keyframe);
    EXPECT_FALSE(check.planes) << fault.expected;
    EXPECT_NE(check.reason.find(fault.expected), std::string::npos) << check.reason;
    EXPECT_NE(check.reason.find("/7/3 refused"), std::string::npos) << check.reason;
  }
}

}  // namespace
}  // namespace planecloud

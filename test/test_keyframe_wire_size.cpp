// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <ros/serialization.h>

#include "planecloud_slam/planecloud_msgs/conversions.h"
#include "planecloud_slam/rosbags/keyframe_wire_size.h"

namespace planecloud {
namespace {

std::size_t messageSize(const Keyframe& keyframe) {
  return ros::serialization::serializationLength(toMessage(keyframe, kUsualOpticalFrame));
}

Keyframe someKeyframe() {
  Keyframe keyframe;
  keyframe.id = {"robot1", 17, 4};
  keyframe.stamp = 1305031102.160407;
  keyframe.planes.camera = {640, 480, 517.3, 516.5, 318.6, 255.3, {}};
  keyframe.planes.bytes.resize(1234);
  return keyframe;
}

TEST(KeyframeWireSize, IsTheMessagesSize) {
  Keyframe keyframe = someKeyframe();
  EXPECT_EQ(keyframeWireSize(keyframe), messageSize(keyframe));
  keyframe.edges.resize(2);
  keyframe.edges[0].other = {"robot1", 17, 3};
  keyframe.edges[1].other = {"other_robot", 3, 9};
  keyframe.closure_hints = {{"robot1", 17, 1}, {"robot2", 17, 1}};
  keyframe.descriptor.resize(241);
  keyframe.texture = {"jpeg-grey", std::vector<std::uint8_t>(500)};
  keyframe.planes.camera.distortion[0] = 0.1;
  EXPECT_EQ(keyframeWireSize(keyframe), messageSize(keyframe));
}

TEST(KeyframeWireSize, AllButPlanesAndDescriptorStaysUnder250Bytes) {
  Keyframe keyframe = someKeyframe();
  keyframe.edges.resize(1);
  keyframe.edges[0].other = {"robot1", 17, 3};
  EXPECT_LT(keyframeWireSize(keyframe) - keyframe.planes.bytes.size(), 250U + 128U);
}

}  // namespace
}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "expect_error.h"
#include "known_keyframe.h"
#include "planecloud_slam/plane_fit/keyframe_rounding.h"
#include "planecloud_slam/planecloud_msgs/conversions.h"

namespace planecloud {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

planecloud_slam::PlaneCloudKeyframe knownMessage() {
  return toMessage(knownKeyframe(), kKnownFrame);
}

/// `change` must make the known message one that is refused with a text that has `parts`.
void expectRefused(const std::function<void(planecloud_slam::PlaneCloudKeyframe&)>& change,
                   const std::vector<std::string>& parts) {
  planecloud_slam::PlaneCloudKeyframe message = knownMessage();
  change(message);
  expectError<MessageError>([&] { static_cast<void>(fromMessage(message)); }, parts);
}

TEST(Conversions, GiveTheKeyframeAsTravelled) {
  expectEqual(fromMessage(knownMessage()), asTravelled(knownKeyframe()));
}

TEST(Conversions, GiveTheKeyframeAsTravelledWithoutEdgesTextureAndDistortion) {
  Keyframe keyframe = knownKeyframe();
  keyframe.edges.clear();
  keyframe.closure_hints.clear();
  keyframe.descriptor.clear();
  keyframe.texture = {};
  keyframe.planes = {};
  keyframe.planes.camera = {640, 480, 525.0, 525.0, 319.5, 239.5, {}};
  expectEqual(fromMessage(toMessage(keyframe, kKnownFrame)), asTravelled(keyframe));
}

TEST(Conversions, GiveHalfTurnsAsTravelled) {
  Keyframe keyframe = knownKeyframe();
  for (int axis = 0; axis < 3; ++axis) {
    Vector6d xi = Vector6d::Zero();
    xi(3 + axis) = 3.14159265358979;
    keyframe.T_odom_camera = expSe3(xi);
    expectEqual(fromMessage(toMessage(keyframe, kKnownFrame)), asTravelled(keyframe));
  }
}

TEST(Conversions, PutStampAndOpticalFrameIntoThePlaneCloudHeader) {
  const planecloud_slam::PlaneCloudKeyframe message = knownMessage();
  EXPECT_EQ(message.plane_cloud.header.frame_id, kKnownFrame);
  EXPECT_EQ(message.plane_cloud.header.stamp.sec, 1305031102U);
  EXPECT_NEAR(message.plane_cloud.header.stamp.nsec, 160407000, 240);  // one step of a double
}

TEST(Conversions, NameTheSessionOfAnotherKeyframeOnlyWhereItDiffers) {
  const planecloud_slam::PlaneCloudKeyframe message = knownMessage();
  EXPECT_TRUE(message.edges[0].other.session.empty());
  ASSERT_EQ(message.edges[1].other.session.size(), 1U);
  EXPECT_EQ(message.edges[1].other.session[0].robot, "robot2");
}

TEST(Conversions, RefuseToSendANameThatCannotBePartOfATopicOrAFile) {
  for (const char* name : {"", "../../etc", "robot 1", "r/1", "r\n"}) {
    Keyframe keyframe = knownKeyframe();
    keyframe.id.robot = name;
    expectError<std::invalid_argument>([&] { static_cast<void>(toMessage(keyframe, kKnownFrame)); },
                                       {"robot name", "~robot"});
  }
}

TEST(Conversions, RefuseToSendAnUnknownTextureFormat) {
  Keyframe keyframe = knownKeyframe();
  keyframe.texture.format = "png";
  expectError<std::invalid_argument>([&] { static_cast<void>(toMessage(keyframe, kKnownFrame)); },
                                     {"texture format 'png'", "jpeg-grey"});
}

TEST(Conversions, RefuseRobotNamesThatLeadOutOfAFolder) {
  expectRefused([](auto& m) { m.robot = "../x"; }, {"robot name '???x'", "letters, digits"});
  expectRefused([](auto& m) { m.robot.clear(); }, {"robot name ''"});
  expectRefused([](auto& m) { m.robot = std::string(65, 'a'); }, {"1 to 64"});
  expectRefused([](auto& m) { m.edges[1].other.session[0].robot = "a b"; },
                {"keyframe robot1/1700000000123456789/42 refused", "edge[1]", "robot name 'a?b'"});
}

TEST(Conversions, RefusePosesThatAreNotFinite) {
  expectRefused([](auto& m) { m.translation[1] = kNaN; }, {"odometry translation", "not finite"});
  expectRefused([](auto& m) { m.rotation[0] = kNaN; }, {"odometry rotation", "not finite"});
  expectRefused([](auto& m) { m.rotation[0] = 4.0F; }, {"odometry rotation", "at most pi"});
  expectRefused([](auto& m) { m.edges[0].translation[2] = 1.0F / 0.0F; }, {"edge[0] translation"});
  expectRefused([](auto& m) { m.edges[1].information[20] = kNaN; }, {"edge[1] information"});
}

TEST(Conversions, RefuseImpossibleCounts) {
  expectRefused([](auto& m) { m.plane_cloud.plane_count = 640 * 480 + 1; },
                {"plane count 307201 is impossible", "640 x 480"});
  expectRefused([](auto& m) { m.plane_cloud.data.clear(); }, {"plane count 3 is impossible"});
  expectRefused([](auto& m) { m.plane_cloud.encoding = 1; },
                {"plane count 3 is impossible for 8 bytes"});
  expectRefused([](auto& m) { m.edges.resize(5000); }, {"edges has 5000 elements"});
  expectRefused([](auto& m) { m.closure_hints.resize(5000); }, {"closure_hints has 5000 elements"});
  expectRefused([](auto& m) { m.descriptor.resize(100000); }, {"descriptor has 100000 elements"});
  expectRefused([](auto& m) { m.edges[0].other.session.resize(2); }, {"edge[0] names 2 sessions"});
}

TEST(Conversions, RefuseUnknownEncodingsNamingTheKnownOnes) {
  expectRefused([](auto& m) { m.plane_cloud.encoding = 9; }, {"encoding 9", "1 (RAW)", "2 (COMP"});
  expectRefused([](auto& m) { m.plane_cloud.encoding = 0; }, {"encoding 0", "update this package"});
  expectRefused([](auto& m) { m.texture_format = 3; }, {"texture format 3", "1 (grey JPEG)"});
}

TEST(Conversions, RefuseATextureWithoutFormatAndAFormatWithoutTexture) {
  expectRefused([](auto& m) { m.texture_format = 0; }, {"texture of format 0 has 4 bytes"});
  expectRefused([](auto& m) { m.texture.clear(); }, {"texture of format 1 has 0 bytes"});
}

TEST(Conversions, RefuseImpossibleCameras) {
  expectRefused([](auto& m) { m.plane_cloud.width = 0; }, {"width = 0"});
  expectRefused([](auto& m) { m.plane_cloud.fx = kNaN; }, {"fx"});
  expectRefused([](auto& m) { m.plane_cloud.fy = -5.0F; }, {"fy"});
  expectRefused([](auto& m) { m.plane_cloud.distortion.resize(3); }, {"distortion has 3"});
  expectRefused([](auto& m) { m.plane_cloud.distortion[0] = kNaN; }, {"k1"});
}

TEST(Conversions, RefuseReferencesToTheKeyframeItselfAndBrokenStamps) {
  expectRefused([](auto& m) { m.edges[0].other.id = m.id; }, {"edge[0]", "itself"});
  expectRefused([](auto& m) { m.closure_hints[0].id = m.id; }, {"closure hint[0]", "itself"});
  expectRefused([](auto& m) { m.plane_cloud.header.stamp.nsec = 2000000000U; }, {"nanoseconds"});
}

TEST(Conversions, IgnoreStopFlagsOfLaterVersions) {
  planecloud_slam::PlaneCloudKeyframe message = knownMessage();
  message.plane_cloud.stopped_by |= 0xF0;
  expectEqual(fromMessage(message), asTravelled(knownKeyframe()));
}

}  // namespace
}  // namespace planecloud

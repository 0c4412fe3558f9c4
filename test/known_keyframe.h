// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>
#include <ros/serialization.h>

#include <cstdint>
#include <vector>

#include "planecloud_slam/plane_fit/keyframe.h"
#include "planecloud_slam/planecloud_msgs/conversions.h"

namespace planecloud {

constexpr const char* kKnownFrame = "camera_rgb_optical_frame";

/// The keyframe in test/fixtures/keyframe_v1.bin: one of everything, numbers that float32 rounds.
inline Keyframe knownKeyframe() {
  Vector6d xi;
  xi << 1.23456789, -20.1, 0.3, 0.4, -1.7, 2.1;
  Keyframe keyframe;
  keyframe.id = {"robot1", 1700000000123456789U, 42};
  keyframe.stamp = 1305031102.160407;
  keyframe.T_odom_camera = expSe3(xi);
  keyframe.planes.camera = {640, 480, 517.3, 516.5, 318.6, 255.3, {0.2624, -0.9531, 0, 0, 1.1633}};
  keyframe.planes.encoding = PlaneCloudEncoding::kCompact;
  keyframe.planes.plane_count = 3;
  keyframe.planes.bytes = {1, 2, 3, 4, 5, 250, 251, 252};
  keyframe.planes.statistics = {0.98765, 0.0027123, 0.0131, 0.01234, false, true};
  RelativePoseEdge previous;
  previous.other = {"robot1", 1700000000123456789U, 41};
  previous.T_other_this = expSe3(0.01 * xi);
  Matrix6d root = Matrix6d::Identity();
  for (int i = 0; i < 36; ++i) root(i / 6, i % 6) += 0.1 * ((i * 7) % 11);
  previous.information = 1e4 * root.transpose() * root;
  RelativePoseEdge other_robot = previous;
  other_robot.other = {"robot2", 1600000000000000001U, 7};
  keyframe.edges = {previous, other_robot};
  keyframe.closure_hints = {{"robot1", 1700000000123456789U, 3}, {"robot3", 5, 9}};
  keyframe.descriptor = {1, 17, 34, 51};
  keyframe.texture = {"jpeg-grey", {0xFF, 0xD8, 0xFF, 0xD9}};
  return keyframe;
}

/// The bytes of `message` as they travel.
template <typename Message>
std::vector<std::uint8_t> serialized(const Message& message) {
  std::vector<std::uint8_t> bytes(ros::serialization::serializationLength(message));
  ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(stream, message);
  return bytes;
}

/// The keyframe message in `bytes`; throws what ros::serialization throws.
inline planecloud_slam::PlaneCloudKeyframe deserialized(std::vector<std::uint8_t> bytes) {
  planecloud_slam::PlaneCloudKeyframe message;
  ros::serialization::IStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::deserialize(stream, message);
  return message;
}

inline void expectEqual(const PlaneCloudStatistics& a, const PlaneCloudStatistics& b) {
  EXPECT_EQ(a.coverage, b.coverage);
  EXPECT_EQ(a.point_plane_error, b.point_plane_error);
  EXPECT_EQ(a.depth_error, b.depth_error);
  EXPECT_EQ(a.fit_time, b.fit_time);
  EXPECT_EQ(a.stopped_by_time, b.stopped_by_time);
  EXPECT_EQ(a.stopped_by_bytes, b.stopped_by_bytes);
}

/// Every field, bit for bit.
inline void expectEqual(const Keyframe& a, const Keyframe& b) {
  EXPECT_EQ(toString(a.id), toString(b.id));
  EXPECT_EQ(a.stamp, b.stamp);
  EXPECT_EQ(a.T_odom_camera.matrix(), b.T_odom_camera.matrix());
  EXPECT_EQ(a.planes.camera, b.planes.camera);
  EXPECT_EQ(a.planes.encoding, b.planes.encoding);
  EXPECT_EQ(a.planes.plane_count, b.planes.plane_count);
  EXPECT_EQ(a.planes.bytes, b.planes.bytes);
  expectEqual(a.planes.statistics, b.planes.statistics);
  ASSERT_EQ(a.edges.size(), b.edges.size());
  for (std::size_t i = 0; i < a.edges.size(); ++i) {
    EXPECT_EQ(a.edges[i].other, b.edges[i].other);
    EXPECT_EQ(a.edges[i].T_other_this.matrix(), b.edges[i].T_other_this.matrix());
    EXPECT_EQ(a.edges[i].information, b.edges[i].information);
  }
  EXPECT_EQ(a.closure_hints, b.closure_hints);
  EXPECT_EQ(a.descriptor, b.descriptor);
  EXPECT_EQ(a.texture.format, b.texture.format);
  EXPECT_EQ(a.texture.bytes, b.texture.bytes);
}

}  // namespace planecloud

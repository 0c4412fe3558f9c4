// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <nav_msgs/Odometry.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <tf2_msgs/TFMessage.h>

#include <cstdio>
#include <filesystem>
#include <map>
#include <set>
#include <string>

#include "planecloud_slam/planecloud_msgs/pose_conversions.h"
#include "planecloud_slam/rosbags/hallway_bag.h"

namespace planecloud {
namespace {

/// A bag of two robots, written once for all tests.
class HallwayBag : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    HallwayBagOptions options;
    options.world.robots = 2;
    options.world.duration = 0.15;
    writeHallwayBag(options, path());
  }
  static void TearDownTestSuite() { std::remove(path().c_str()); }
  static std::string path() {
    return (std::filesystem::temp_directory_path() / "test_hallway_bag.bag").string();
  }

  rosbag::Bag bag_{path(), rosbag::bagmode::Read};
};

TEST_F(HallwayBag, StaticTransformsLeadFromTheFloorToTheOpticalFrame) {
  rosbag::View view(bag_, rosbag::TopicQuery("/tf_static"));
  ASSERT_EQ(view.size(), 1U);  // a player repeats the last latched message alone
  EXPECT_EQ(view.getConnections().front()->header->at("latching"), "1");
  std::map<std::string, geometry_msgs::TransformStamped> parents;
  const auto message = view.begin()->instantiate<tf2_msgs::TFMessage>();
  for (const auto& transform : message->transforms) parents[transform.child_frame_id] = transform;
  for (const std::string robot : {"robot1", "robot2"}) {
    Eigen::Isometry3d T_base_camera = Eigen::Isometry3d::Identity();
    std::string frame = robot + "/camera_rgb_optical_frame";
    while (parents.count(frame) != 0) {
      T_base_camera = fromMessage(parents[frame].transform) * T_base_camera;
      frame = parents[frame].header.frame_id;
    }
    EXPECT_EQ(frame, robot + "/base_footprint");
    EXPECT_TRUE(T_base_camera.isApprox(HallwayRecording::T_base_camera(), 1e-9));
  }
}

TEST_F(HallwayBag, OdometryIsOnItsTopicAndOnTfThirtyTimesASecond) {
  rosbag::View odometry(bag_, rosbag::TopicQuery("/robot2/odom"));
  EXPECT_EQ(odometry.size(), 5U);
  const auto message = odometry.begin()->instantiate<nav_msgs::Odometry>();
  EXPECT_EQ(message->header.frame_id, "robot2/odom");
  EXPECT_EQ(message->child_frame_id, "robot2/base_footprint");
  std::map<std::string, int> transforms;
  rosbag::View tf(bag_, rosbag::TopicQuery("/tf"));
  for (const rosbag::MessageInstance& instance : tf) {
    const auto tf_message = instance.instantiate<tf2_msgs::TFMessage>();
    for (const auto& transform : tf_message->transforms) {
      ++transforms[transform.header.frame_id + " -> " + transform.child_frame_id];
    }
  }
  const std::map<std::string, int> expected{{"robot1/odom -> robot1/base_footprint", 5},
                                            {"robot2/odom -> robot2/base_footprint", 5}};
  EXPECT_EQ(transforms, expected);
}

TEST_F(HallwayBag, TopicsAreThoseOfOpenni2LaunchInEachNamespace) {
  std::set<std::string> topics;
  rosbag::View view(bag_);
  for (const auto* connection : view.getConnections()) topics.insert(connection->topic);
  std::set<std::string> expected{"/tf", "/tf_static"};
  for (const std::string robot : {"/robot1", "/robot2"}) {
    for (const char* const topic :
         {"/camera/rgb/image_rect_color", "/camera/rgb/camera_info",
          "/camera/depth_registered/image_raw", "/odom", "/ground_truth"}) {
      expected.insert(robot + topic);
    }
  }
  EXPECT_EQ(topics, expected);
}

}  // namespace
}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

#include "planecloud_slam/rosbags/bag_recording.h"
#include "planecloud_slam/rosbags/bag_writer.h"
#include "planecloud_slam/rosbags/hallway_bag.h"
#include "planecloud_slam/rosbags/sequence_folder.h"

namespace planecloud {
namespace {

namespace fs = std::filesystem;

CameraIntrinsics cameraOf(int width, int height) {
  CameraIntrinsics camera;
  camera.width = width;
  camera.height = height;
  camera.fx = camera.fy = width;
  camera.cx = 0.5 * width;
  camera.cy = 0.5 * height;
  return camera;
}

class BagRecordingTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const ::testing::TestInfo* test = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() / (std::string("bag_") + test->name());
    fs::create_directories(folder_);
    path_ = (folder_ / "test.bag").string();
  }
  void TearDown() override { fs::remove_all(folder_); }

  /// A pair whose grey level and depth tell it apart.
  void writePair(BagWriter& bag, double stamp, int level, const CameraIntrinsics& camera,
                 double color_delay = 0.0) {
    bag.writeCameraInfo(topics_, camera, toRosTime(stamp));
    bag.writeColor(topics_,
                   cv::Mat(camera.height, camera.width, CV_8UC3, cv::Scalar(level, level, level)),
                   toRosTime(stamp + color_delay));
    bag.writeDepth(
        topics_,
        Image<std::uint16_t>(camera.width, camera.height, static_cast<std::uint16_t>(1000 + level)),
        toRosTime(stamp));
  }

  /// What openBag says of the bag, or what the first failing next() says.
  std::string failure() {
    try {
      for (const auto& recording : openBag(path_)) {
        while (recording->next()) {
        }
      }
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return {};
  }

  CameraTopics topics_ = rectifiedTopics("");
  CameraIntrinsics camera_ = cameraOf(64, 48);
  fs::path folder_;
  std::string path_;
};

void expectEqual(const RgbdFrame& a, const RgbdFrame& b) {
  EXPECT_EQ(a.stamp, b.stamp);
  EXPECT_TRUE(std::equal(a.grey.begin(), a.grey.end(), b.grey.begin()));
  for (std::size_t i = 0; i < a.depth.size(); ++i) {
    const float z = a.depth.begin()[i];
    ASSERT_TRUE(z == b.depth.begin()[i] || (std::isnan(z) && std::isnan(b.depth.begin()[i])));
  }
}

TEST_F(BagRecordingTest, AHallwayBagGivesTheFramesOfTheBuiltInWorldBitForBit) {
  HallwayBagOptions options;
  options.world.seed = 3;
  options.world.robots = 2;
  options.world.duration = 0.2;
  writeHallwayBag(options, path_);
  const auto bags = openBag(path_);
  const auto worlds = makeHallwayRecordings(options.world);
  ASSERT_EQ(bags.size(), 2U);
  for (std::size_t robot = 0; robot < 2; ++robot) {
    EXPECT_EQ(bags[robot]->robot(), worlds[robot]->robot());
    EXPECT_EQ(bags[robot]->camera(), worlds[robot]->camera());
    ASSERT_EQ(bags[robot]->size(), worlds[robot]->size());
    while (const std::optional<RgbdFrame> rendered = worlds[robot]->next()) {
      const std::optional<RgbdFrame> read = bags[robot]->next();
      ASSERT_TRUE(read);
      expectEqual(*read, *rendered);
    }
    EXPECT_FALSE(bags[robot]->next());
    const Trajectory& truth = bags[robot]->groundTruth();
    ASSERT_EQ(truth.size(), worlds[robot]->groundTruth().size());
    EXPECT_EQ(truth.back().stamp, worlds[robot]->groundTruth().back().stamp);
    EXPECT_TRUE(truth.back().pose.isApprox(worlds[robot]->groundTruth().back().pose, 1e-9));
  }
}

TEST_F(BagRecordingTest, ABagInColourHoldsTheSameGreyLevels) {
  HallwayBagOptions options;
  options.color = true;
  options.world.duration = 0.05;
  writeHallwayBag(options, path_);
  const auto recording = std::move(openBag(path_).front());
  HallwayRecording world(options.world);
  expectEqual(recording->next().value(), world.next().value());
  EXPECT_EQ(cv::norm(recording->color(), world.color(), cv::NORM_INF), 0.0);
}

TEST_F(BagRecordingTest, PairsTheImagesNearestInTimeWithin20Milliseconds) {
  BagWriter bag(path_);
  writePair(bag, 100.0, 1, camera_, 0.015);
  writePair(bag, 100.1, 2, camera_, 0.03);  // too late for its depth
  writePair(bag, 100.2, 3, camera_, -0.01);
  bag.close();
  const auto recording = std::move(openBag(path_).front());
  const RgbdFrame first = recording->next().value();
  EXPECT_EQ(first.stamp, 100.0);
  EXPECT_EQ(first.grey(0, 0), 1);
  const RgbdFrame second = recording->next().value();
  EXPECT_NEAR(second.stamp, 100.2, 1e-6);
  EXPECT_EQ(second.grey(0, 0), 3);
  EXPECT_FALSE(recording->next());
}

TEST_F(BagRecordingTest, StampsOfALoopedBagGoBackAndNoPairMixesTheRounds) {
  BagWriter bag(path_);
  for (int i = 0; i < 5; ++i) writePair(bag, 100.0 + i, 10 + i, camera_);
  bag.close();
  // The same stamps again, recorded later.
  const std::string looped = (folder_ / "looped.bag").string();
  {
    const rosbag::Bag once(path_, rosbag::bagmode::Read);
    rosbag::Bag twice(looped, rosbag::bagmode::Write);
    for (const double delay : {0.0, 50.0}) {
      rosbag::View view(once);
      for (const rosbag::MessageInstance& message : view) {
        twice.write(message.getTopic(), message.getTime() + ros::Duration(delay), message);
      }
    }
  }
  path_ = looped;
  const auto recording = std::move(openBag(path_).front());
  std::vector<double> stamps;
  while (const std::optional<RgbdFrame> frame = recording->next()) {
    EXPECT_EQ(1000 + frame->grey(0, 0), std::lround(1e3 * double{frame->depth(0, 0)}));
    stamps.push_back(frame->stamp);
  }
  EXPECT_EQ(stamps, std::vector<double>({100, 101, 102, 103, 104, 100, 101, 102, 103, 104}));
}

TEST_F(BagRecordingTest, ABagThatEndsInMidMessageGivesWhatIsWholeAndOneClearMessage) {
  BagWriter bag(path_);
  const CameraIntrinsics camera = cameraOf(640, 480);
  for (int i = 0; i < 12; ++i) writePair(bag, 100.0 + i, i, camera);
  bag.close();
  fs::resize_file(path_, fs::file_size(path_) * 3 / 4);
  std::vector<std::string> warnings;
  const auto recordings =
      openBag(path_, [&](const std::string& text) { warnings.push_back(text); });
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("rosbag reindex"), std::string::npos);
  EXPECT_NE(warnings[0].find(path_), std::string::npos);
  int frames = 0;
  while (const std::optional<RgbdFrame> frame = recordings.front()->next()) {
    EXPECT_EQ(frame->grey(3, 3), frames++);
  }
  EXPECT_GE(frames, 6);
  EXPECT_LT(frames, 12);
}

TEST_F(BagRecordingTest, ABagThatWasNeverClosedIsReadToo) {
  BagWriter bag(path_);
  const CameraIntrinsics camera = cameraOf(640, 480);
  for (int i = 0; i < 3; ++i) writePair(bag, 100.0 + i, i, camera);
  // The chunk being written is lost, the ones before are on the disk.
  std::vector<std::string> warnings;
  const auto recordings =
      openBag(path_, [&](const std::string& text) { warnings.push_back(text); });
  EXPECT_EQ(warnings.size(), 1U);
  EXPECT_TRUE(recordings.front()->next());
}

TEST_F(BagRecordingTest, MissingCameraInfoIsNamedWithItsCure) {
  BagWriter bag(path_);
  bag.writeColor(topics_, cv::Mat(48, 64, CV_8UC3, cv::Scalar(0, 0, 0)), toRosTime(1.0));
  bag.writeDepth(topics_, Image<float>(64, 48, 1.0F), toRosTime(1.0));
  bag.close();
  EXPECT_NE(failure().find("record /camera/rgb/camera_info"), std::string::npos) << failure();
}

TEST_F(BagRecordingTest, DifferingSizesAreNamedWithTheirCure) {
  BagWriter bag(path_);
  bag.writeCameraInfo(topics_, camera_, toRosTime(1.0));
  bag.writeColor(topics_, cv::Mat(48, 64, CV_8UC3, cv::Scalar(0, 0, 0)), toRosTime(1.0));
  bag.writeDepth(topics_, Image<float>(32, 24, 1.0F), toRosTime(1.0));
  bag.close();
  EXPECT_NE(failure().find("registered"), std::string::npos) << failure();
}

TEST_F(BagRecordingTest, ASizeThatChangesInMidStreamIsNamedWithItsCure) {
  BagWriter bag(path_);
  writePair(bag, 1.0, 1, camera_);
  writePair(bag, 2.0, 2, cameraOf(32, 24));
  bag.close();
  EXPECT_NE(failure().find("changes in mid-stream"), std::string::npos) << failure();
}

TEST_F(BagRecordingTest, AnUnknownEncodingIsNamed) {
  BagWriter bag(path_);
  bag.writeCameraInfo(topics_, camera_, toRosTime(1.0));
  bag.writeDepth(topics_, Image<float>(64, 48, 1.0F), toRosTime(1.0));
  sensor_msgs::Image image;
  image.header.stamp = toRosTime(1.0);
  image.width = 64;
  image.height = 48;
  image.step = 128;
  image.encoding = "yuv422";
  image.data.resize(128 * 48);
  bag.write(topics_.color, image);
  bag.close();
  EXPECT_NE(failure().find("yuv422"), std::string::npos) << failure();
}

TEST_F(BagRecordingTest, ABagWithoutACameraSaysWhatItHas) {
  BagWriter bag(path_);
  bag.writeGroundTruth("/ground_truth", {1.0, Eigen::Isometry3d::Identity()});
  bag.close();
  EXPECT_NE(failure().find("it has /ground_truth"), std::string::npos) << failure();
}

TEST_F(BagRecordingTest, AFileThatIsNoBagIsNamed) {
  std::ofstream(path_) << "nothing of the kind\n";
  EXPECT_NE(failure().find(path_), std::string::npos) << failure();
  path_ = (folder_ / "missing.bag").string();
  EXPECT_NE(failure().find(path_), std::string::npos) << failure();
}

TEST(FindRobots, KnowsTheNamesOfOpenniOrbbecAndTum) {
  const auto robots = [](const std::string& color, const std::string& depth,
                         const std::string& info) {
    return findRobots("a.bag", {{color, "sensor_msgs/Image"},
                                {depth, "sensor_msgs/Image"},
                                {info, "sensor_msgs/CameraInfo"}});
  };
  EXPECT_EQ(robots("/camera/rgb/image_color", "/camera/depth/image", "/camera/rgb/camera_info")
                .front()
                .robot,
            "robot1");
  EXPECT_EQ(robots("/a/camera/color/image_raw", "/a/camera/depth/image_raw",
                   "/a/camera/color/camera_info")
                .front()
                .robot,
            "a");
  EXPECT_EQ(
      robots("/b/rgb/image_rect_color", "/b/depth_registered/image_rect", "/b/rgb/camera_info")
          .front()
          .robot,
      "b");
}

TEST(FindRobots, PrefersRectifiedColourAndRegisteredDepth) {
  const std::string image = "sensor_msgs/Image";
  const auto robots = findRobots("a.bag", {{"/camera/depth/image_raw", image},
                                           {"/camera/rgb/image_raw", image},
                                           {"/camera/depth_registered/image_raw", image},
                                           {"/camera/rgb/image_rect_color", image},
                                           {"/camera/rgb/camera_info", "sensor_msgs/CameraInfo"}});
  ASSERT_EQ(robots.size(), 1U);
  EXPECT_EQ(robots[0].color, "/camera/rgb/image_rect_color");
  EXPECT_EQ(robots[0].depth, "/camera/depth_registered/image_raw");
}

}  // namespace
}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include "planecloud_slam/rosbags/bag_recording.h"
#include "planecloud_slam/rosbags/sequence_bag.h"
#include "planecloud_slam/rosbags/sequence_recording.h"

namespace planecloud {
namespace {

namespace fs = std::filesystem;

/// A folder with three pairs of differing stamps, holes in the depth and ground truth.
class SequenceBag : public ::testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(folder_ / "rgb");
    fs::create_directories(folder_ / "depth");
    std::ofstream associations(folder_ / "associations.txt");
    for (int i = 0; i < 3; ++i) {
      const std::string name = std::to_string(i) + ".png";
      cv::Mat color(24, 32, CV_8UC3);
      cv::Mat depth(24, 32, CV_16UC1);
      cv::randu(color, 0, 255);
      cv::randu(depth, 0, 30000);
      depth.row(3).setTo(0);
      cv::imwrite((folder_ / "rgb" / name).string(), color);
      cv::imwrite((folder_ / "depth" / name).string(), depth);
      associations << "1305031102.1" << i << "5304 rgb/" << name << " 1305031102.1" << i
                   << "0328 depth/" << name << "\n";
    }
    std::ofstream(folder_ / "groundtruth.txt")
        << "1305031102.1000 1.0 2.0 3.0 0 0 0 1\n1305031102.1100 1.5 2.0 3.0 0 0 0.6 0.8\n";
    std::ofstream(folder_ / "camera.yaml")
        << "fx: 30\nfy: 31\ncx: 15.5\ncy: 11.5\ndistortion: [0.1, -0.02, 0.001, 0.002, 0.0]\n";
  }
  void TearDown() override { fs::remove_all(folder_); }

  const fs::path folder_ = fs::temp_directory_path() / "test_sequence_bag";
  const std::string path_ = (folder_ / "out.bag").string();
};

TEST_F(SequenceBag, ReplaysToTheSameFramesAsTheFolder) {
  const SequenceFolder folder = openSequenceFolder(folder_.string(), {});
  writeSequenceBag(folder, path_);
  SequenceRecording sequence(folder, "robot1");
  const auto bags = openBag(path_);
  ASSERT_EQ(bags.size(), 1U);
  // Neither topic is called rectified, so that the lens distortion stays in force.
  EXPECT_EQ(bags.front()->camera(), folder.camera);
  while (const std::optional<RgbdFrame> from_folder = sequence.next()) {
    const std::optional<RgbdFrame> from_bag = bags.front()->next();
    ASSERT_TRUE(from_bag);
    EXPECT_EQ(from_bag->stamp, from_folder->stamp);
    EXPECT_TRUE(
        std::equal(from_bag->grey.begin(), from_bag->grey.end(), from_folder->grey.begin()));
    for (std::size_t i = 0; i < from_bag->depth.size(); ++i) {
      const float a = from_bag->depth.begin()[i];
      const float b = from_folder->depth.begin()[i];
      ASSERT_TRUE(a == b || (std::isnan(a) && std::isnan(b)));
    }
    EXPECT_EQ(cv::norm(bags.front()->color(), sequence.color(), cv::NORM_INF), 0.0);
  }
  EXPECT_FALSE(bags.front()->next());
}

TEST_F(SequenceBag, CarriesTheGroundTruth) {
  const SequenceFolder folder = openSequenceFolder(folder_.string(), {});
  writeSequenceBag(folder, path_);
  const auto bags = openBag(path_);
  const Trajectory& truth = bags.front()->groundTruth();
  ASSERT_EQ(truth.size(), folder.ground_truth.size());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    EXPECT_NEAR(truth[i].stamp, folder.ground_truth[i].stamp, 1e-6);
    EXPECT_TRUE(truth[i].pose.isApprox(folder.ground_truth[i].pose, 1e-9));
  }
}

}  // namespace
}  // namespace planecloud

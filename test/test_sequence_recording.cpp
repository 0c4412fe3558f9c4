// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgcodecs.hpp>

#include "expect_error.h"
#include "planecloud_slam/rosbags/camera_file.h"
#include "planecloud_slam/rosbags/sequence_recording.h"
#include "planecloud_slam/rosbags/usage_error.h"
#include "temporary_folder.h"

namespace planecloud {
namespace {

constexpr int kWidth = 32;
constexpr int kHeight = 24;
const char* const kCameraYaml =
    "fx: 30.5\nfy: 31\ncx: 15.5\ncy: 11.5\ndistortion: [0.1, -0.2]\ndepth_scale: 1000\n";

/// A sequence of two pairs on disk.
class SequenceRecordingTest : public testing::Test {
 protected:
  SequenceRecordingTest() {
    folder_.write("associations.txt",
                  "# colour, depth\n1.5 rgb/1.png 1.25 depth/1.png\n2.5 rgb/2.png 2.25 "
                  "depth/2.png\n");
    folder_.write("camera.yaml", kCameraYaml);
    folder_.write("groundtruth.txt", "1 0 0 0 0 0 0 1\n2 1 0 0 0 0 0 1\n");
    for (const char* name : {"1.png", "2.png"}) {
      writeColor(name, kWidth, kHeight);
      writeDepth(name, kWidth, kHeight);
    }
  }

  void writeColor(const std::string& name, int width, int height) const {
    std::filesystem::create_directories(folder_ / "rgb");
    cv::imwrite(folder_ / "rgb/" + name, cv::Mat(height, width, CV_8UC3, cv::Scalar(0, 0, 200)));
  }

  void writeDepth(const std::string& name, int width, int height) const {
    std::filesystem::create_directories(folder_ / "depth");
    cv::Mat depth(height, width, CV_16UC1, cv::Scalar(1500));
    depth.at<std::uint16_t>(2, 3) = 0;
    cv::imwrite(folder_ / "depth/" + name, depth);
  }

  [[nodiscard]] SequenceRecording open(const SequenceOptions& options = {}) const {
    return {openSequenceFolder(folder_.path(), options), "robot1"};
  }

  template <typename Error = std::runtime_error>
  void expectOpenError(const std::vector<std::string>& parts,
                       const SequenceOptions& options = {}) const {
    expectError<Error>([&] { (void)open(options); }, parts);
  }

  void expectReadError(const std::vector<std::string>& parts) const {
    SequenceRecording recording = open();
    expectError<std::runtime_error>(
        [&] {
          while (recording.next()) {
          }
        },
        parts);
  }

  TemporaryFolder folder_;
};

TEST_F(SequenceRecordingTest, GivesEachPairWithTheStampOfItsDepth) {
  SequenceRecording recording = open();
  EXPECT_EQ(recording.robot(), "robot1");
  EXPECT_EQ(recording.size(), 2U);
  EXPECT_EQ(recording.groundTruth().size(), 2U);
  const auto first = recording.next();
  ASSERT_TRUE(first.has_value());
  EXPECT_EQ(first->stamp, 1.25);
  EXPECT_EQ(recording.color().type(), CV_8UC3);
  const auto second = recording.next();
  ASSERT_TRUE(second.has_value());
  EXPECT_EQ(second->stamp, 2.25);
  EXPECT_FALSE(recording.next().has_value());
}

TEST_F(SequenceRecordingTest, DepthIsInMetresAndNoDepthIsNaN) {
  const auto frame = open().next();
  ASSERT_TRUE(frame.has_value());
  EXPECT_FLOAT_EQ(frame->depth(0, 0), 1.5F);
  EXPECT_TRUE(std::isnan(frame->depth(3, 2)));
  EXPECT_EQ(frame->grey(0, 0), 60);  // 0.299 of a red of 200
}

TEST_F(SequenceRecordingTest, TakesTheCameraFromItsFileAndTheSizeFromTheImages) {
  const SequenceRecording recording = open();
  EXPECT_EQ(recording.camera().width, kWidth);
  EXPECT_EQ(recording.camera().height, kHeight);
  EXPECT_EQ(recording.camera().fx, 30.5);
  EXPECT_EQ(recording.camera().distortion[1], -0.2);
  EXPECT_EQ(recording.camera().distortion[4], 0.0);
}

TEST_F(SequenceRecordingTest, FlagsGoBeforeTheCameraFile) {
  SequenceOptions options;
  options.camera = parseCameraFlag("40,41,16,12");
  options.depth_scale = 500.0;
  SequenceRecording recording = open(options);
  EXPECT_EQ(recording.camera().fx, 40.0);
  EXPECT_FALSE(recording.camera().hasDistortion());
  EXPECT_EQ(recording.next()->depth(0, 0), 3.0F);
}

TEST_F(SequenceRecordingTest, WithoutACameraItNamesTheFlag) {
  std::filesystem::remove(folder_ / "camera.yaml");
  expectOpenError<UsageError>({"camera.yaml", "--camera"});
  SequenceOptions options;
  options.camera = parseCameraFlag("40,41,16,12");
  EXPECT_EQ(open(options).camera().width, kWidth);
}

TEST_F(SequenceRecordingTest, AcceptsAssociationsThatNameDepthFirst) {
  folder_.write("associations.txt", "1.25 depth/1.png 1.5 rgb/1.png\n");
  EXPECT_EQ(open().next()->stamp, 1.25);
}

TEST_F(SequenceRecordingTest, NamesAMissingFileAndItsLine) {
  std::filesystem::remove(folder_ / "depth/2.png");
  expectOpenError({"associations.txt:3", "depth/2.png"});
}

TEST_F(SequenceRecordingTest, NamesABadLineOfTheAssociations) {
  folder_.write("associations.txt", "1.5 rgb/1.png 1.25 depth/1.png\n1.5 rgb/1.png\n");
  expectOpenError({"associations.txt:2", "expected"});
}

TEST_F(SequenceRecordingTest, RefusesFoldersThatAreNoSequence) {
  expectError<std::runtime_error>([] { (void)openSequenceFolder("/no/such", {}); }, {"/no/such"});
  folder_.write("associations.txt", "# nothing\n");
  expectOpenError({"associations.txt", "no pair"});
  std::filesystem::remove(folder_ / "associations.txt");
  expectOpenError({"associations.txt", "cannot read"});
}

TEST_F(SequenceRecordingTest, NamesImagesThatCannotBeRead) {
  cv::imwrite(folder_ / "depth/2.png", cv::Mat(kHeight, kWidth, CV_8UC1, cv::Scalar(9)));
  expectReadError({"depth/2.png", "16 bits"});
  folder_.write("rgb/2.png", "no image");
  expectReadError({"rgb/2.png", "cannot read image"});
}

TEST_F(SequenceRecordingTest, RefusesSizesThatDiffer) {
  writeColor("2.png", kWidth, kHeight + 2);
  expectReadError({"32x26", "32x24", "registered"});
  writeColor("2.png", kWidth + 2, kHeight);
  writeDepth("2.png", kWidth + 2, kHeight);
  expectReadError({"depth/2.png", "34x24", "camera 32x24"});
}

TEST_F(SequenceRecordingTest, NamesWhatIsWrongInTheCameraFile) {
  folder_.write("camera.yaml", "fx: 30\nfy: 30\ncx: 15\n");
  expectOpenError({"camera.yaml", "cy is missing"});
  folder_.write("camera.yaml", std::string(kCameraYaml) + "focal: 3\n");
  expectOpenError({"camera.yaml", "unknown key 'focal'"});
  folder_.write("camera.yaml", "fx: wide\nfy: 30\ncx: 15\ncy: 11\n");
  expectOpenError({"camera.yaml", "fx", "wrong type"});
  folder_.write("camera.yaml", "fx: [1\n");
  expectOpenError({"camera.yaml"});
}

TEST(CameraFlag, ReadsFourToNineNumbers) {
  const CameraIntrinsics camera = parseCameraFlag("517.3,516.5,318.6,255.3,0.26,-0.95,0,0,1.16");
  EXPECT_EQ(camera.fy, 516.5);
  EXPECT_EQ(camera.distortion[4], 1.16);
  for (const char* wrong : {"", "1,2,3", "1,2,3,4,", "1,2,x,4", "1,2,3,4,5,6,7,8,9,10", "0,1,2,3",
                            "1 2 3 4", "nan,1,2,3"}) {
    expectError<UsageError>([&] { (void)parseCameraFlag(wrong); }, {"--camera"});
  }
}

}  // namespace
}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <sstream>
#include <string>

#include "temporary_folder.h"

namespace planecloud {
namespace {

/// What a program did.
struct Outcome {
  int status = -1;
  std::string out;
  std::string error;
};

class ToolsTest : public testing::Test {
 protected:
  [[nodiscard]] std::string read(const std::string& name) const {
    std::ifstream file(folder_ / name);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
  }

  [[nodiscard]] Outcome run(const std::string& program, const std::string& arguments) const {
    const std::string command =
        "'" + program + "' " + arguments + " >" + (folder_ / "out") + " 2>" + (folder_ / "error");
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read("out"), read("error")};
  }

  /// Replays a few frames of the built-in world into folder `name`.
  [[nodiscard]] Outcome replayHallway(const std::string& name, const std::string& flags) const {
    return run(REPLAY, "hallway:3:2 --max-frames 8 --output " + (folder_ / name) + " " + flags);
  }

  TemporaryFolder folder_;
};

TEST_F(ToolsTest, ExplainThemselves) {
  for (const char* program : {REPLAY, COMPRESS, EVALUATE_TRAJECTORY}) {
    const Outcome outcome = run(program, "--help");
    EXPECT_EQ(outcome.status, 0) << program;
    EXPECT_NE(outcome.out.find("Usage: "), std::string::npos) << program;
    EXPECT_TRUE(outcome.error.empty()) << outcome.error;
  }
}

TEST_F(ToolsTest, ExitWithTwoAfterWrongUse) {
  const std::string out = " --output " + (folder_ / "x");
  const std::vector<std::pair<const char*, std::string>> cases = {
      {REPLAY, ""},
      {REPLAY, "hallway:1"},                             // no --output
      {REPLAY, "hallway:one" + out},                     // no number
      {REPLAY, "hallway:1:0" + out},                     // no robot
      {REPLAY, "/no/such/folder" + out},                 // no input
      {REPLAY, "hallway:1 --keyframe-spacing 0" + out},  // out of range
      {REPLAY, "hallway:1 --camera 1,2,3" + out},        // too few numbers
      {COMPRESS, "hallway:1 --min-tile 1"},              // out of range
      {COMPRESS, "hallway:1 --acceptance sometimes"},    // unknown
      {COMPRESS, "hallway:1 --encoding sometimes"},      // unknown
      {COMPRESS, "hallway:1 --texture blue"},            // unknown
      {COMPRESS, "hallway:1 --lambda -1"},               // out of range
      {COMPRESS, "hallway:1 --every 0"},                 // out of range
      {COMPRESS, "hallway:1 hallway:2"},                 // two inputs
      {EVALUATE_TRAJECTORY, "one.txt"},                  // an odd number
  };
  for (const auto& [program, arguments] : cases) {
    const Outcome outcome = run(program, arguments);
    EXPECT_EQ(outcome.status, 2) << program << ' ' << arguments;
    EXPECT_NE(outcome.error.find("--help"), std::string::npos) << outcome.error;
  }
}

TEST_F(ToolsTest, ExitWithTwoAndTheCureWhenTheCameraIsUnknown) {
  folder_.write("rgb/1.png", "");
  folder_.write("depth/1.png", "");
  folder_.write("associations.txt", "1 rgb/1.png 1 depth/1.png\n");
  const Outcome outcome = run(COMPRESS, folder_.path());
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.error.find("--camera"), std::string::npos) << outcome.error;
}

TEST_F(ToolsTest, EvaluateTrajectoryWritesItsKeys) {
  std::string trajectory;
  for (int i = 0; i < 300; ++i) {
    trajectory += std::to_string(0.01 * i) + " " + std::to_string(0.02 * i) + " " +
                  std::to_string(i % 7) + " 0 0 0 0 1\n";
  }
  const std::string path = folder_.write("a.txt", trajectory);
  const Outcome outcome = run(EVALUATE_TRAJECTORY, path + " " + path + " --json");
  ASSERT_EQ(outcome.status, 0) << outcome.error;
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json.at("pairs"), 300);
  EXPECT_LT(json.at("ate_rmse_m"), 1e-9);
  for (const char* key : {"rpe_trans_rmse_m", "rpe_rot_rmse_deg", "end_drift_percent"}) {
    EXPECT_TRUE(json.contains(key)) << key;
  }
  folder_.write("b.txt", "1 2 3\n");
  const Outcome bad = run(EVALUATE_TRAJECTORY, path + " " + (folder_ / "b.txt"));
  EXPECT_EQ(bad.status, 1);
  EXPECT_NE(bad.error.find("b.txt:1"), std::string::npos) << bad.error;
}

TEST_F(ToolsTest, ReplayWritesTheSameFilesWhateverTheThreads) {
  const Outcome one = replayHallway("one", "--threads 1");
  ASSERT_EQ(one.status, 0) << one.error;
  const Outcome again = replayHallway("again", "--threads 1");
  const Outcome many = replayHallway("many", "--threads 4");
  ASSERT_EQ(many.status, 0) << many.error;
  for (const char* robot : {"robot1", "robot2"}) {
    for (const char* kind : {"frames", "keyframes", "odometry", "groundtruth"}) {
      const std::string name = std::string("/") + robot + "_" + kind + ".txt";
      EXPECT_GT(read("one" + name).size(), 50U) << name;
      EXPECT_EQ(read("one" + name), read("again" + name)) << name;
      EXPECT_EQ(read("one" + name), read("many" + name)) << name;
    }
  }
  EXPECT_FALSE(cv::imread(folder_ / "one/map.png").empty());
  EXPECT_EQ(read("one/map.ply").substr(0, 3), "ply");
}

TEST_F(ToolsTest, ReplayReportsItsKeys) {
  const Outcome outcome = replayHallway("r", "--no-loop-closure --no-history");
  ASSERT_EQ(outcome.status, 0) << outcome.error;
  const auto report = nlohmann::json::parse(read("r/report.json"));
  const auto& robot = report.at("robots").at("robot2");
  EXPECT_EQ(robot.at("frames"), 8);
  for (const char* key : {"tracked", "lost", "keyframes", "path_m"}) {
    EXPECT_TRUE(robot.contains(key)) << key;
  }
  EXPECT_TRUE(robot.at("keyframe_bytes").contains("mean"));
  EXPECT_TRUE(robot.at("keyframe_bytes").contains("total"));
  EXPECT_TRUE(robot.at("track_ms").contains("p95"));
  EXPECT_TRUE(robot.at("fit_ms").contains("median"));
  for (const char* key : {"intra", "inter", "rejected"}) {
    EXPECT_TRUE(report.at("loop_closures").contains(key)) << key;
  }
  for (const char* key :
       {"coplanar_edges", "components", "optimize_ms", "realtime_factor", "peak_rss_mb"}) {
    EXPECT_TRUE(report.contains(key)) << key;
  }
  for (const char* key : {"ate_rmse_m", "odometry_ate_rmse_m", "closures_false",
                          "closures_possible", "closures_found"}) {
    EXPECT_TRUE(report.at("ground_truth").contains(key)) << key;
  }
}

/// One pair of images of a slanted plane as a TUM folder.
void writeSequence(const TemporaryFolder& folder) {
  cv::Mat depth(480, 640, CV_16UC1);
  for (int y = 0; y < depth.rows; ++y) {
    for (int x = 0; x < depth.cols; ++x) {
      depth.at<std::uint16_t>(y, x) = static_cast<std::uint16_t>(5000.0 / (0.5 + 0.0005 * x));
    }
  }
  folder.write("camera.yaml", "fx: 525\nfy: 525\ncx: 319.5\ncy: 239.5\n");
  folder.write("associations.txt", "1 rgb/1.png 1 depth/1.png\n");
  folder.write("rgb/1.png", "");
  folder.write("depth/1.png", "");
  cv::imwrite(folder / "rgb/1.png", cv::Mat(480, 640, CV_8UC3, cv::Scalar(90, 120, 150)));
  cv::imwrite(folder / "depth/1.png", depth);
}

TEST_F(ToolsTest, CompressWritesItsKeysPicturesAndTable) {
  writeSequence(folder_);
  const Outcome outcome = run(COMPRESS, folder_.path() + " --json --csv " + (folder_ / "t.csv") +
                                            " --pictures " + (folder_ / "p"));
  ASSERT_EQ(outcome.status, 0) << outcome.error;
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json.at("images"), 1);
  EXPECT_GT(json.at("coverage"), 0.95);
  EXPECT_LT(json.at("point_plane_mm"), 2.0);  // a plane, quantised
  EXPECT_LT(json.at("bytes").at("mean"), json.at("raw_bytes").at("mean"));
  for (const char* key : {"fit_ms", "encode_ms", "decode_ms"}) {
    EXPECT_TRUE(json.at(key).contains("median") && json.at(key).contains("p95")) << key;
  }
  for (const char* key : {"depth_error_mm", "bits_per_plane"}) {
    EXPECT_TRUE(json.contains(key)) << key;
  }
  EXPECT_TRUE(json.at("planes").contains("mean"));
  EXPECT_FALSE(json.contains("true_error_mm"));
  for (const char* kind : {"depth", "error", "tiles"}) {
    EXPECT_FALSE(cv::imread(folder_ / ("p/robot1_000000_" + std::string(kind) + ".png")).empty());
  }
  EXPECT_EQ(read("t.csv").rfind("robot,stamp,", 0), 0U);
}

}  // namespace
}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "planecloud_slam/rosbags/astra_sensor_model.h"
#include "planecloud_slam/rosbags/hallway_renderer.h"
#include "planecloud_slam/rosbags/hallway_world.h"
#include "planecloud_slam/rosbags/recording.h"
#include "planecloud_slam/rosbags/robot_path.h"

namespace planecloud {

/// 640 x 480 pixels, focal length 570 px.
[[nodiscard]] CameraIntrinsics astraCamera();

/// What one robot records in the built-in world.
struct HallwayOptions {
  std::uint64_t seed = 1;          ///< of textures, furniture, path and noise
  int robot = 0;                   ///< index of the robot, [0, robots)
  int robots = 1;                  ///< how many record at the same time, [1, 16]
  double duration = 84.0;          ///< [s], (0, 3600]; once around the block and 8 s or more again
  bool noise = true;               ///< the Astra's; false: exact depth in whole millimetres
  std::optional<DriveKind> drive;  ///< none: robots 0, 1, 2, ... take different ones in turn
  CameraIntrinsics camera = astraCamera();
};

/// A TurtleBot's camera in the built-in world, rendered frame by frame at 15 Hz. Depth is rounded
/// to millimetres before it is returned, so that a bag's 16UC1 images hold the same values.
class HallwayRecording : public Recording {
 public:
  static constexpr int kFramesPerSecond = 15;
  static constexpr int kOdometryPerSecond = 30;

  /// Throws std::invalid_argument naming the option that is out of range. `world` may be shared by
  /// robots of the same seed; none: it is built.
  explicit HallwayRecording(const HallwayOptions& options,
                            std::shared_ptr<const HallwayWorld> world = nullptr);

  [[nodiscard]] const std::string& robot() const override { return robot_; }
  [[nodiscard]] const CameraIntrinsics& camera() const override { return options_.camera; }
  [[nodiscard]] std::size_t size() const override { return ground_truth_.size(); }
  [[nodiscard]] std::optional<RgbdFrame> next() override;
  /// One pose per frame, exact.
  [[nodiscard]] const Trajectory& groundTruth() const override { return ground_truth_; }
  /// Exact depth of every pixel, also of those where the sensor gave no answer [m].
  [[nodiscard]] std::optional<Image<float>> trueDepth() const override { return true_depth_; }
  [[nodiscard]] cv::Mat color() const override { return color_; }

  /// Depth of the frame last returned as the sensor sends it [mm], 0: none.
  [[nodiscard]] const Image<std::uint16_t>& depthMillimetres() const { return depth_; }
  /// Time of frame or odometry sample `index` at `rate` per second, exact in nanoseconds [ns].
  [[nodiscard]] static std::uint64_t stampNanoseconds(std::size_t index, int rate);
  /// What the wheels say, 30 times a second: pose of the base in `odom` and its speeds.
  [[nodiscard]] const std::vector<BaseState>& odometry() const { return odometry_; }
  /// The optical frame in base_footprint.
  [[nodiscard]] static Eigen::Isometry3d T_base_camera();

 private:
  HallwayOptions options_;
  std::string robot_;
  std::uint64_t noise_seed_ = 0;
  HallwayRenderer renderer_;
  Trajectory ground_truth_;
  std::vector<BaseState> odometry_;
  std::size_t position_ = 0;
  Image<std::uint16_t> depth_;
  std::optional<Image<float>> true_depth_;
  cv::Mat color_;
};

/// The recordings of all robots of a run, `options.robot` aside; they share one world.
[[nodiscard]] std::vector<std::unique_ptr<HallwayRecording>> makeHallwayRecordings(
    const HallwayOptions& options);

}  // namespace planecloud

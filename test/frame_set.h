// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "planecloud_slam/rosbags/recording.h"

namespace planecloud {

/// A recording held in memory, so that many runs see the same frames.
struct FrameSet {
  std::string name;
  CameraIntrinsics camera;
  std::vector<std::shared_ptr<const RgbdFrame>> frames;
  Trajectory truth;  ///< optical frame in the world; empty: unknown
  /// Motion of the optical frame since the frame before, as the wheels report it; empty: no wheels.
  std::vector<std::optional<Eigen::Isometry3d>> wheels;
  std::optional<Eigen::Isometry3d> T_base_camera;  ///< of a robot that drives on a floor
};

/// Reads INPUT: a folder in the TUM layout, `hallway:SEED` (the drive around the block) or
/// `corridor:SEED` (once along its hallway of 15 m). Throws std::runtime_error or UsageError.
[[nodiscard]] FrameSet loadFrameSet(const std::string& input, std::size_t max_frames = 0);

/// The frames of a set as a recording.
class MemoryRecording : public Recording {
 public:
  explicit MemoryRecording(std::shared_ptr<const FrameSet> set, std::string robot = "robot1")
      : set_(std::move(set)), robot_(std::move(robot)) {}

  [[nodiscard]] const std::string& robot() const override { return robot_; }
  [[nodiscard]] const CameraIntrinsics& camera() const override { return set_->camera; }
  [[nodiscard]] std::size_t size() const override { return set_->frames.size(); }
  [[nodiscard]] std::optional<RgbdFrame> next() override {
    if (position_ == set_->frames.size()) return std::nullopt;
    return *set_->frames[position_++];
  }
  [[nodiscard]] const Trajectory& groundTruth() const override { return set_->truth; }
  [[nodiscard]] std::optional<Eigen::Isometry3d> startPose() const override {
    return set_->T_base_camera;
  }

 private:
  std::shared_ptr<const FrameSet> set_;
  std::string robot_;
  std::size_t position_ = 0;
};

}  // namespace planecloud

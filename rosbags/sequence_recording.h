// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <opencv2/core.hpp>
#include <optional>
#include <string>

#include "planecloud_slam/rosbags/recording.h"
#include "planecloud_slam/rosbags/sequence_folder.h"

namespace planecloud {

/// A folder in the TUM layout as a recording. Images are read when asked for.
class SequenceRecording : public Recording {
 public:
  /// `robot`: name of the robot that recorded it.
  SequenceRecording(SequenceFolder folder, std::string robot);

  [[nodiscard]] const std::string& robot() const override { return robot_; }
  [[nodiscard]] const CameraIntrinsics& camera() const override { return folder_.camera; }
  [[nodiscard]] std::size_t size() const override { return folder_.pairs.size(); }
  [[nodiscard]] std::optional<RgbdFrame> next() override;
  [[nodiscard]] const Trajectory& groundTruth() const override { return folder_.ground_truth; }
  [[nodiscard]] cv::Mat color() const override { return color_; }

 private:
  const SequenceFolder folder_;
  const std::string robot_;
  std::size_t position_ = 0;
  cv::Mat color_;
};

}  // namespace planecloud

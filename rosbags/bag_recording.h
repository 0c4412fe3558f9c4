// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/Image.h>

#include <deque>
#include <functional>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "planecloud_slam/rosbags/bag_contents.h"
#include "planecloud_slam/rosbags/recording.h"
#include "planecloud_slam/rosbags/recovered_bag.h"

namespace planecloud {

/// Where to find a bag's messages: the file itself, or what could be recovered of it.
struct BagSource {
  std::string path;                         ///< as the user named it
  std::shared_ptr<RecoveredBag> recovered;  ///< none: the file is whole

  [[nodiscard]] const std::string& file() const { return recovered ? recovered->path() : path; }
};

/// One robot's camera out of a bag. A depth image is paired with the colour image nearest in time,
/// at most 20 ms away; others are dropped. Where stamps run backwards (a bag recorded from a looped
/// player) pairing starts anew and the stamps simply go back.
class BagRecording : public Recording {
 public:
  /// Throws std::runtime_error naming file, topic, cause and cure.
  BagRecording(BagSource source, RobotTopics topics);

  [[nodiscard]] const std::string& robot() const override { return topics_.robot; }
  [[nodiscard]] const CameraIntrinsics& camera() const override { return camera_; }
  /// Number of depth images.
  [[nodiscard]] std::size_t size() const override { return size_; }
  [[nodiscard]] std::optional<RgbdFrame> next() override;
  [[nodiscard]] const Trajectory& groundTruth() const override { return ground_truth_; }
  [[nodiscard]] cv::Mat color() const override;

 private:
  struct ImagePair {
    sensor_msgs::ImageConstPtr color;
    sensor_msgs::ImageConstPtr depth;
  };

  void readCamera();
  void readGroundTruth();
  [[nodiscard]] bool readMessage();
  void receive(const sensor_msgs::ImageConstPtr& image, bool is_depth);
  [[nodiscard]] std::optional<ImagePair> takePair(bool at_end);
  [[nodiscard]] RgbdFrame decode(const ImagePair& pair);
  void checkSizes(const ImagePair& pair) const;
  [[noreturn]] void refuse(const std::string& topic, const std::string& cause) const;

  BagSource source_;
  RobotTopics topics_;
  rosbag::Bag bag_;
  std::unique_ptr<rosbag::View> view_;
  rosbag::View::iterator position_;
  std::size_t size_ = 0;
  std::size_t returned_ = 0;
  CameraIntrinsics camera_;
  Trajectory ground_truth_;
  std::deque<sensor_msgs::ImageConstPtr> colors_;
  std::deque<sensor_msgs::ImageConstPtr> depths_;
  double newest_ = 0.0;  ///< stamp of all images since time last ran backwards [s]
  sensor_msgs::ImageConstPtr last_color_;
};

/// Opens a bag, one recording per robot. `warn` hears of damage that leaves something to read, in
/// one sentence with the cure. Throws std::runtime_error naming file, cause and cure.
[[nodiscard]] std::vector<std::unique_ptr<Recording>> openBag(
    const std::string& path, const std::function<void(const std::string&)>& warn = {});

}  // namespace planecloud

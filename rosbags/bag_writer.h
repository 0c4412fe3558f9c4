// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <geometry_msgs/TransformStamped.h>
#include <ros/time.h>
#include <rosbag/bag.h>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "planecloud_slam/plane_fit/camera.h"
#include "planecloud_slam/rosbags/recording.h"

namespace planecloud {

/// Where a camera's images go. Topics start with a slash.
struct CameraTopics {
  std::string color;
  std::string depth;
  std::string camera_info;
  std::string frame;  ///< of all headers
};

/// Rectified images under openni2_launch's names, `/camera/rgb/image_rect_color`,
/// `/camera/depth_registered/image_raw`, `/camera/rgb/camera_info`; `space` ("/robot1" or "") goes
/// before the topics and, without its slash, before the frame.
[[nodiscard]] CameraTopics rectifiedTopics(const std::string& space);
/// Images as they left the lens under the names of the TUM benchmark's bags,
/// `/camera/rgb/image_color`, `/camera/depth/image`, `/camera/rgb/camera_info`: nothing in them
/// says rectified, so that the frontend undistorts them.
[[nodiscard]] CameraTopics rawTopics();

/// `frame` within the namespace of a robot: "robot1/odom", or "odom" for no namespace.
[[nodiscard]] std::string frameIn(const std::string& space, const std::string& frame);
/// A transform for tf.
[[nodiscard]] geometry_msgs::TransformStamped transformMessage(
    const Eigen::Isometry3d& T_parent_child, const ros::Time& stamp, const std::string& parent,
    const std::string& child);

/// A compressed bag (lz4) being written. Every method throws std::runtime_error naming the file
/// when the disk refuses.
class BagWriter {
 public:
  explicit BagWriter(const std::string& path);
  /// Removes a bag that was not closed: half of one would pass for a whole.
  ~BagWriter();
  BagWriter(const BagWriter&) = delete;
  BagWriter& operator=(const BagWriter&) = delete;

  /// Writes the index; a bag that was never closed has none.
  void close();

  void writeCameraInfo(const CameraTopics& topics, const CameraIntrinsics& camera,
                       const ros::Time& stamp);
  /// `bgr`: 8UC3, written as rgb8.
  void writeColor(const CameraTopics& topics, const cv::Mat& bgr, const ros::Time& stamp);
  /// Written as mono8.
  void writeGrey(const CameraTopics& topics, const Image<std::uint8_t>& grey,
                 const ros::Time& stamp);
  /// Depth in millimetres, 0: none (16UC1).
  void writeDepth(const CameraTopics& topics, const Image<std::uint16_t>& depth,
                  const ros::Time& stamp);
  /// Depth in metres, NaN: none (32FC1).
  void writeDepth(const CameraTopics& topics, const Image<float>& depth, const ros::Time& stamp);
  /// geometry_msgs/PoseStamped of the optical frame in `world`.
  void writeGroundTruth(const std::string& topic, const StampedPose& truth);
  /// On /tf.
  void writeTransform(const geometry_msgs::TransformStamped& transform);
  /// On /tf_static, latched: all of them at once, since a player repeats the last message alone.
  void writeStaticTransforms(const std::vector<geometry_msgs::TransformStamped>& transforms);
  /// Any other message, at its header's stamp.
  template <typename Message>
  void write(const std::string& topic, const Message& message) {
    writeAt(topic, message.header.stamp, message);
  }

 private:
  void writeImage(const std::string& topic, const CameraTopics& topics, const cv::Mat& pixels,
                  const std::string& encoding, const ros::Time& stamp);
  template <typename Message>
  void writeAt(const std::string& topic, const ros::Time& stamp, const Message& message);

  std::string path_;
  rosbag::Bag bag_;
  bool is_closed_ = false;
};

/// Nearest nanosecond.
[[nodiscard]] ros::Time toRosTime(double stamp);

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <image_transport/image_transport.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <ros/spinner.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include <atomic>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "planecloud_slam/frontend_node/frontend_node_options.h"
#include "planecloud_slam/frontend_node/input_monitor.h"
#include "planecloud_slam/frontend_node/rgbd_synchronizer.h"
#include "planecloud_slam/planecloud_msgs/log_throttle.h"

namespace planecloud {

/// A colour-depth pair as it came, with the camera that saw it.
struct InputFrame {
  sensor_msgs::ImageConstPtr color;
  sensor_msgs::ImageConstPtr depth;
  sensor_msgs::CameraInfoConstPtr camera_info;
  int time_jumps = 0;  ///< how often time went back before it
};

/// Subscribes to the camera and pairs its images. Has its own thread, so that a callback that waits
/// (`~drop_frames` off) holds up nothing else.
class RgbdInput {
 public:
  using OnFrame = std::function<void(InputFrame)>;

  /// `on_frame` is called for each pair from the input's thread once `start` was called.
  RgbdInput(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
            const InputOptions& options, OnFrame on_frame);
  ~RgbdInput();

  void start();
  /// No callback runs after it returns; none must be waiting forever when it is called.
  void stop();

  /// Whether `camera_info.P` describes the images.
  [[nodiscard]] bool isRectified() const { return rectified_; }

  /// Warns about silent or unsynchronised topics; call it now and then.
  void reportProblems();
  /// Time since the last image [s]; large before the first one.
  [[nodiscard]] double silence() const;
  /// Messages per second of the colour topic.
  [[nodiscard]] double rate() const;

 private:
  void subscribe(const ros::NodeHandle& private_node);
  void onImage(InputMonitor::Topic topic, const sensor_msgs::ImageConstPtr& image);
  void onCameraInfo(const sensor_msgs::CameraInfoConstPtr& camera_info);
  void onPair(const sensor_msgs::ImageConstPtr& color, const sensor_msgs::ImageConstPtr& depth);
  void passOn(InputFrame frame);
  void warnOfMixedRectification(const sensor_msgs::CameraInfo& camera_info) const;

  const InputOptions options_;
  const OnFrame on_frame_;
  ros::CallbackQueue callbacks_;
  ros::NodeHandle node_;
  bool rectified_ = false;
  RgbdSynchronizer synchronizer_;
  sensor_msgs::CameraInfoConstPtr camera_info_;
  std::deque<InputFrame> without_camera_info_;
  int time_jumps_ = 0;

  mutable std::mutex monitor_mutex_;
  InputMonitor monitor_;
  std::atomic<double> last_image_;  ///< [s] of the wall clock
  LogThrottle log_;

  image_transport::Subscriber color_subscriber_;
  image_transport::Subscriber depth_subscriber_;
  ros::Subscriber camera_info_subscriber_;
  ros::AsyncSpinner spinner_;
};

}  // namespace planecloud

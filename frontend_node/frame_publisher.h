// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/ros.h>
#include <tf2_ros/transform_broadcaster.h>

#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "planecloud_slam/frontend_node/frame_tracker.h"
#include "planecloud_slam/frontend_node/frontend_node_options.h"
#include "planecloud_slam/frontend_node/keyframe_compressor.h"
#include "planecloud_slam/frontend_node/odometry_covariance.h"
#include "planecloud_slam/frontend_node/odometry_source.h"

namespace planecloud {

/// Publishes what live frames give: `visual_odom` with its covariance, tf if asked to. Lost frames
/// have the last known pose and the covariance of what is unknown, and no tf. For one thread.
class VisualOdometryPublisher {
 public:
  /// `odometry` must outlive the publisher.
  VisualOdometryPublisher(ros::NodeHandle node, const FrontendNodeOptions& options,
                          const OdometrySource& odometry);

  void publish(const TrackedFrame& tracked);

 private:
  void findMount(const std::string& camera_frame);

  const std::string odom_frame_;
  const std::string base_frame_;
  const bool publish_tf_;
  const OdometrySource& odometry_;
  std::string camera_frame_;
  std::optional<Eigen::Isometry3d> T_camera_base_;  ///< none: the camera stands for the base
  OdometryCovariance covariance_;
  ros::Publisher publisher_;
  tf2_ros::TransformBroadcaster broadcaster_;
};

/// Fits and publishes the planes of live frames, `plane_cloud` and `plane_markers`. For one thread.
class PlanePreviewPublisher {
 public:
  PlanePreviewPublisher(ros::NodeHandle node, const FrontendOptions& options);

  /// Whether anybody looks.
  [[nodiscard]] bool isWanted() const;
  void publish(TrackedFrame tracked);

 private:
  KeyframeCompressor compressor_;
  ros::Publisher planes_;
  ros::Publisher markers_;
};

}  // namespace planecloud

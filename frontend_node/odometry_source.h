// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include <Eigen/Geometry>
#include <mutex>
#include <optional>
#include <string>

#include "planecloud_slam/frontend_node/frontend_node_options.h"

namespace planecloud {

/// Poses of the camera in the robot's odometry frame: from tf where something publishes them, else
/// visual odometry. Safe to use from several threads.
class OdometrySource {
 public:
  explicit OdometrySource(const FrontendNodeOptions& options);

  /// tf's `odom -> camera` at `stamp` [s]; waits for it as long as the options allow, by the wall
  /// clock, if the frames exist at all.
  [[nodiscard]] std::optional<Eigen::Isometry3d> findOdomCamera(const std::string& camera_frame,
                                                                double stamp) const;
  /// Motion of the camera by the wheels, `T_previous_current`, from the frame asked for before to
  /// the one at `stamp` [s]; none without `~guess_frame`, or where tf has not both. For one thread.
  [[nodiscard]] std::optional<Eigen::Isometry3d> findWheelMotion(const std::string& camera_frame,
                                                                 double stamp);
  /// The camera's mount, tf's `base -> camera`.
  [[nodiscard]] std::optional<Eigen::Isometry3d> findBaseCamera(
      const std::string& camera_frame) const;

  /// T_odom_camera of a keyframe whose visual odometry is `T_visual_camera`. Where tf has gaps,
  /// visual odometry bridges them from the last pose that tf had.
  [[nodiscard]] Eigen::Isometry3d keyframePose(const std::string& camera_frame, double stamp,
                                               const Eigen::Isometry3d& T_visual_camera);

  /// Time went back: nothing known so far holds any more.
  void clear();

 private:
  [[nodiscard]] std::optional<Eigen::Isometry3d> find(const std::string& target,
                                                      const std::string& source,
                                                      const ros::Time& stamp) const;

  const std::string odom_frame_;   ///< empty: visual odometry alone
  const std::string guess_frame_;  ///< of the wheels; empty: none
  const std::string base_frame_;
  const double wait_;  ///< [s]
  tf2_ros::Buffer buffer_;
  tf2_ros::TransformListener listener_;
  std::optional<Eigen::Isometry3d> T_guess_previous_;  ///< camera of the frame before
  std::mutex mutex_;
  std::optional<Eigen::Isometry3d> T_odom_visual_;
};

}  // namespace planecloud

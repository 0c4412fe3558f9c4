// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/frontend_node/odometry_source.h"

#include <ros/time.h>

#include "planecloud_slam/planecloud_msgs/pose_conversions.h"

namespace planecloud {

OdometrySource::OdometrySource(const FrontendNodeOptions& options)
    : odom_frame_(options.publish_odom_tf ? "" : options.odom_frame),
      guess_frame_(options.guess_frame),
      base_frame_(options.base_frame),
      wait_(options.tf_wait),
      listener_(buffer_) {}

std::optional<Eigen::Isometry3d> OdometrySource::findOdomCamera(const std::string& camera_frame,
                                                                double stamp) const {
  if (odom_frame_.empty() || !buffer_._frameExists(odom_frame_)) return std::nullopt;
  return find(odom_frame_, camera_frame, ros::Time(stamp));
}

std::optional<Eigen::Isometry3d> OdometrySource::findWheelMotion(const std::string& camera_frame,
                                                                 double stamp) {
  if (guess_frame_.empty() || !buffer_._frameExists(guess_frame_)) return std::nullopt;
  const std::optional<Eigen::Isometry3d> T_guess_previous = T_guess_previous_;
  T_guess_previous_ = find(guess_frame_, camera_frame, ros::Time(stamp));
  if (!T_guess_previous || !T_guess_previous_) return std::nullopt;
  return T_guess_previous->inverse() * *T_guess_previous_;
}

std::optional<Eigen::Isometry3d> OdometrySource::findBaseCamera(
    const std::string& camera_frame) const {
  return find(base_frame_, camera_frame, ros::Time(0));
}

std::optional<Eigen::Isometry3d> OdometrySource::find(const std::string& target,
                                                      const std::string& source,
                                                      const ros::Time& stamp) const {
  // tf's own waiting follows simulated time, which may stand still.
  const ros::WallTime deadline = ros::WallTime::now() + ros::WallDuration(wait_);
  while (!buffer_.canTransform(target, source, stamp)) {
    if (ros::WallTime::now() >= deadline) return std::nullopt;
    ros::WallDuration(0.01).sleep();
  }
  try {
    return fromMessage(buffer_.lookupTransform(target, source, stamp).transform);
  } catch (const tf2::TransformException&) {
    return std::nullopt;
  } catch (const MessageError&) {
    return std::nullopt;
  }
}

Eigen::Isometry3d OdometrySource::keyframePose(const std::string& camera_frame, double stamp,
                                               const Eigen::Isometry3d& T_visual_camera) {
  const std::optional<Eigen::Isometry3d> T_odom_camera = findOdomCamera(camera_frame, stamp);
  const std::lock_guard<std::mutex> lock(mutex_);
  if (T_odom_camera) T_odom_visual_ = *T_odom_camera * T_visual_camera.inverse();
  return T_odom_visual_ ? *T_odom_visual_ * T_visual_camera : T_visual_camera;
}

void OdometrySource::clear() {
  buffer_.clear();
  T_guess_previous_.reset();
  const std::lock_guard<std::mutex> lock(mutex_);
  T_odom_visual_.reset();
}

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/frontend_node/frame_publisher.h"

#include <nav_msgs/Odometry.h>
#include <visualization_msgs/MarkerArray.h>

#include <utility>

#include "planecloud_slam/plane_fit/plane_cloud_codec.h"
#include "planecloud_slam/planecloud_msgs/conversions.h"
#include "planecloud_slam/planecloud_msgs/plane_triangles.h"
#include "planecloud_slam/planecloud_msgs/pose_conversions.h"

namespace planecloud {
namespace {

constexpr char kVisualOdomFrame[] = "visual_odom";
constexpr double kMaxMarkerDepth = 10.0;  // [m]

std_msgs::ColorRGBA previewColor() {
  std_msgs::ColorRGBA color;
  color.r = 0.55F;
  color.g = 0.75F;
  color.b = 0.95F;
  color.a = 1.0F;
  return color;
}

}  // namespace

VisualOdometryPublisher::VisualOdometryPublisher(ros::NodeHandle node,
                                                 const FrontendNodeOptions& options,
                                                 const OdometrySource& odometry)
    : odom_frame_(options.odom_frame.empty() ? kVisualOdomFrame : options.odom_frame),
      base_frame_(options.base_frame),
      publish_tf_(options.publish_odom_tf),
      odometry_(odometry),
      publisher_(node.advertise<nav_msgs::Odometry>("visual_odom", 50)) {}

void VisualOdometryPublisher::publish(const TrackedFrame& tracked) {
  const Matrix6d at_camera = covariance_.update(tracked.result);
  findMount(tracked.camera_frame);
  Eigen::Isometry3d T_odom_child = tracked.result.T_odom_camera;
  if (T_camera_base_) T_odom_child = T_odom_child * *T_camera_base_;

  nav_msgs::Odometry odometry;
  odometry.header.stamp = ros::Time(tracked.frame.stamp);
  odometry.header.frame_id = odom_frame_;
  odometry.child_frame_id = T_camera_base_ ? base_frame_ : tracked.camera_frame;
  odometry.pose.pose = toPoseMessage(T_odom_child);
  const Matrix6d at_child =
      T_camera_base_ ? transformCovariance(T_camera_base_->inverse(), at_camera) : at_camera;
  const Matrix6d along_odom =
      transformCovariance(Eigen::Isometry3d(T_odom_child.linear()), at_child);
  Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(odometry.pose.covariance.data()) =
      along_odom;
  publisher_.publish(odometry);
  if (!publish_tf_ || tracked.result.status == TrackingStatus::kLost) return;

  geometry_msgs::TransformStamped transform;
  transform.header = odometry.header;
  transform.child_frame_id = odometry.child_frame_id;
  transform.transform = toTransformMessage(T_odom_child);
  broadcaster_.sendTransform(transform);
}

void VisualOdometryPublisher::findMount(const std::string& camera_frame) {
  if (camera_frame == camera_frame_) return;
  camera_frame_ = camera_frame;
  const std::optional<Eigen::Isometry3d> T_base_camera = odometry_.findBaseCamera(camera_frame);
  T_camera_base_.reset();
  if (T_base_camera) {
    T_camera_base_ = T_base_camera->inverse();
    return;
  }
  ROS_WARN_STREAM("tf has no transform from "
                  << camera_frame << " to " << base_frame_
                  << ": visual odometry is that of the camera; publish the mount as a static "
                     "transform or set ~base_frame");
}

PlanePreviewPublisher::PlanePreviewPublisher(ros::NodeHandle node, const FrontendOptions& options)
    : compressor_(options),
      planes_(node.advertise<planecloud_slam::PlaneCloud>("plane_cloud", 2)),
      markers_(node.advertise<visualization_msgs::MarkerArray>("plane_markers", 2)) {}

bool PlanePreviewPublisher::isWanted() const {
  return planes_.getNumSubscribers() > 0 || markers_.getNumSubscribers() > 0;
}

void PlanePreviewPublisher::publish(TrackedFrame tracked) {
  CompletedKeyframe live;
  live.keyframe.stamp = tracked.frame.stamp;
  live.depth = std::move(tracked.frame.depth);
  live.grey = std::move(tracked.frame.grey);
  live.camera = tracked.camera;  // texture stays away: a preview shows planes
  const Keyframe fitted = compressor_.compress(std::move(live), {&FitBudget::Clock::now, {}});
  const planecloud_slam::PlaneCloud message =
      toMessage(fitted.planes, fitted.stamp, tracked.camera_frame);
  planes_.publish(message);
  if (markers_.getNumSubscribers() == 0) return;

  visualization_msgs::MarkerArray markers;
  markers.markers.push_back(
      makeTriangleMarker(tileTriangles(decode(fitted.planes), kMaxMarkerDepth), previewColor()));
  markers.markers.back().header = message.header;
  markers.markers.back().ns = "planes";
  markers_.publish(markers);
}

}  // namespace planecloud

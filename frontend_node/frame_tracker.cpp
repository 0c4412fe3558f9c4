// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/frontend_node/frame_tracker.h"

#include <ros/console.h>

#include <utility>

#include "planecloud_slam/planecloud_msgs/image_conversions.h"

namespace planecloud {
namespace {

std::string sizeText(std::uint32_t width, std::uint32_t height) {
  return std::to_string(width) + " x " + std::to_string(height);
}

/// All three must speak of the same pixels.
void checkSizes(const InputFrame& input) {
  const auto check = [&](const std::string& what, std::uint32_t width, std::uint32_t height,
                         const std::string& cure) {
    if (width == input.color->width && height == input.color->height) return;
    refuseMessage("the colour image is " + sizeText(input.color->width, input.color->height) +
                  " but " + what + " is " + sizeText(width, height) + ": " + cure);
  };
  check("the depth image", input.depth->width, input.depth->height,
        "switch on depth registration, or run both streams in one mode");
  check("camera_info", input.camera_info->width, input.camera_info->height,
        "use the camera_info of these images, calibrated in this mode");
}

}  // namespace

FrameTracker::FrameTracker(const FrontendNodeOptions& options, std::string robot,
                           std::uint64_t session, OdometrySource& odometry)
    : options_(options.frontend),
      robot_(std::move(robot)),
      session_(session),
      odometry_(odometry) {}

TrackedFrame FrameTracker::track(const InputFrame& input, const ImageReading& reading) {
  checkSizes(input);
  TrackedFrame tracked;
  tracked.frame.stamp = input.depth->header.stamp.toSec();
  tracked.frame.color_delay = input.color->header.stamp.toSec() - tracked.frame.stamp;
  tracked.frame.grey = greyFromMessage(*input.color);
  tracked.frame.depth = depthFromMessage(*input.depth);
  if (reading.wants_color) tracked.frame.color = colorFromMessage(*input.color);
  tracked.camera = fromMessage(*input.camera_info, reading.rectified);
  tracked.camera_frame = camera_frame_ = input.color->header.frame_id;
  useCamera(tracked.camera);
  if (input.time_jumps != time_jumps_) {
    time_jumps_ = input.time_jumps;
    frontend_->startNewSegment();
    odometry_.clear();
    is_placed_ = false;
  }
  if (!is_placed_) placeSegment(tracked.frame.stamp);
  tracked.result = frontend_->track(tracked.frame,
                                    odometry_.findWheelMotion(camera_frame_, tracked.frame.stamp));
  return tracked;
}

void FrameTracker::useCamera(const CameraIntrinsics& camera) {
  if (frontend_ && camera == camera_) return;
  if (frontend_) {
    ROS_WARN_STREAM("the camera changed to " << camera.width << " x " << camera.height
                                             << " pixels, focal length " << camera.fx
                                             << ": a new segment of the map begins");
    frontend_->changeCamera(camera);
  } else {
    frontend_.emplace(options_, camera, robot_, session_);
  }
  camera_ = camera;
}

void FrameTracker::placeSegment(double stamp) {
  is_placed_ = true;
  std::optional<Eigen::Isometry3d> T_odom_camera = odometry_.findOdomCamera(camera_frame_, stamp);
  if (!T_odom_camera) T_odom_camera = odometry_.findBaseCamera(camera_frame_);
  if (T_odom_camera) return frontend_->setNextPose(*T_odom_camera);
  if (options_.planar) {
    ROS_WARN_STREAM(
        "~planar takes the camera for level: tf does not know how it is mounted; publish "
        << "~base_frame -> " << camera_frame_);
  }
}

std::vector<CompletedKeyframe> FrameTracker::takeCompleted() {
  return frontend_ ? frontend_->takeCompleted() : std::vector<CompletedKeyframe>();
}

void FrameTracker::setKeyframeOptions(const KeyframeSelectorOptions& options) {
  options_.keyframe = options;
  if (frontend_) frontend_->setKeyframeOptions(options);
}

void FrameTracker::finish() {
  if (frontend_) frontend_->finish();
}

}  // namespace planecloud

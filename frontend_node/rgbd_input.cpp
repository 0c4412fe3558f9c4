// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/frontend_node/rgbd_input.h"

#include <algorithm>
#include <utility>

namespace planecloud {
namespace {

constexpr char kColorTopic[] = "rgb/image_rect_color";
constexpr char kDepthTopic[] = "depth_registered/image_rect";
constexpr char kCameraInfoTopic[] = "rgb/camera_info";

double wallNow() { return ros::WallTime::now().toSec(); }

bool isNamedRectified(const std::string& topic) { return topic.find("rect") != std::string::npos; }

/// "depth_registered" speaks of registration, not of the lens.
std::string lastName(const std::string& topic) { return topic.substr(topic.rfind('/') + 1); }

bool decideRectified(RectifyMode mode, const std::string& color_topic) {
  if (mode == RectifyMode::kAuto) return isNamedRectified(lastName(color_topic));
  return mode == RectifyMode::kNever;
}

}  // namespace

RgbdInput::RgbdInput(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                     const InputOptions& options, OnFrame on_frame)
    : options_(options),
      on_frame_(std::move(on_frame)),
      node_(node),
      rectified_(decideRectified(options.rectify, node.resolveName(kColorTopic))),
      synchronizer_(options,
                    [this](const auto& color, const auto& depth) { onPair(color, depth); }),
      monitor_({node.resolveName(kColorTopic), node.resolveName(kDepthTopic),
                node.resolveName(kCameraInfoTopic)},
               wallNow()),
      last_image_(0.0),
      spinner_(1, &callbacks_) {
  node_.setCallbackQueue(&callbacks_);
  subscribe(private_node);
}

RgbdInput::~RgbdInput() { stop(); }

void RgbdInput::subscribe(const ros::NodeHandle& private_node) {
  image_transport::ImageTransport images(node_);
  const image_transport::TransportHints hints("raw", ros::TransportHints().tcpNoDelay(),
                                              private_node);
  const auto queue = static_cast<std::uint32_t>(options_.subscriber_queue);
  color_subscriber_ = images.subscribe(
      kColorTopic, queue,
      [this](const sensor_msgs::ImageConstPtr& image) { onImage(InputMonitor::kColor, image); },
      ros::VoidPtr(), hints);
  depth_subscriber_ = images.subscribe(
      kDepthTopic, queue,
      [this](const sensor_msgs::ImageConstPtr& image) { onImage(InputMonitor::kDepth, image); },
      ros::VoidPtr(), image_transport::TransportHints("raw", ros::TransportHints().tcpNoDelay()));
  camera_info_subscriber_ =
      node_.subscribe(kCameraInfoTopic, queue, &RgbdInput::onCameraInfo, this);
}

void RgbdInput::start() { spinner_.start(); }

void RgbdInput::stop() {
  spinner_.stop();
  callbacks_.disable();
}

void RgbdInput::reportProblems() {
  const std::lock_guard<std::mutex> lock(monitor_mutex_);
  const std::string problem = monitor_.takeProblem(wallNow());
  if (!problem.empty()) log_.warn(problem);
}

double RgbdInput::silence() const { return wallNow() - last_image_; }

double RgbdInput::rate() const {
  const std::lock_guard<std::mutex> lock(monitor_mutex_);
  return monitor_.rate(InputMonitor::kColor);
}

void RgbdInput::onImage(InputMonitor::Topic topic, const sensor_msgs::ImageConstPtr& image) {
  last_image_ = wallNow();
  bool jumped = false;
  {
    const std::lock_guard<std::mutex> lock(monitor_mutex_);
    jumped = monitor_.noteMessage(topic, image->header.stamp.toSec());
  }
  if (jumped) {
    ROS_WARN(
        "time went back to %.3f: a bag began again? A new segment of the map begins, images "
        "that wait for a partner and tf are forgotten",
        image->header.stamp.toSec());
    synchronizer_.clear();
    without_camera_info_.clear();
    ++time_jumps_;
  }
  if (topic == InputMonitor::kColor) {
    synchronizer_.addColor(image);
  } else {
    synchronizer_.addDepth(image);
  }
}

void RgbdInput::onCameraInfo(const sensor_msgs::CameraInfoConstPtr& camera_info) {
  {
    const std::lock_guard<std::mutex> lock(monitor_mutex_);
    monitor_.noteMessage(InputMonitor::kCameraInfo, camera_info->header.stamp.toSec());
  }
  if (!camera_info_) warnOfMixedRectification(*camera_info);
  camera_info_ = camera_info;
  for (InputFrame& frame : std::exchange(without_camera_info_, {})) passOn(std::move(frame));
}

void RgbdInput::onPair(const sensor_msgs::ImageConstPtr& color,
                       const sensor_msgs::ImageConstPtr& depth) {
  {
    const std::lock_guard<std::mutex> lock(monitor_mutex_);
    monitor_.notePair();
  }
  InputFrame frame{color, depth, nullptr, time_jumps_};
  if (camera_info_) {
    passOn(std::move(frame));
    return;
  }
  if (without_camera_info_.size() >= static_cast<std::size_t>(options_.sync_queue)) {
    without_camera_info_.pop_front();
  }
  without_camera_info_.push_back(std::move(frame));
}

void RgbdInput::passOn(InputFrame frame) {
  frame.camera_info = camera_info_;
  on_frame_(std::move(frame));
}

void RgbdInput::warnOfMixedRectification(const sensor_msgs::CameraInfo& camera_info) const {
  const auto& lens = camera_info.D;
  if (std::all_of(lens.begin(), lens.end(), [](double k) { return k == 0.0; })) return;
  const std::string color = node_.resolveName(kColorTopic);
  const std::string depth = node_.resolveName(kDepthTopic);
  if (isNamedRectified(lastName(color)) == isNamedRectified(lastName(depth))) return;
  ROS_WARN_STREAM("by their names, one of "
                  << color << " and " << depth
                  << " is rectified and the other is not: subscribe to both rectified or both raw");
}

}  // namespace planecloud

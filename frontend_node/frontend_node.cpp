// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/frontend_node/frontend_node.h"

#include <diagnostic_msgs/DiagnosticArray.h>

#include <algorithm>
#include <utility>

#include "planecloud_slam/planecloud_msgs/diagnostics.h"
#include "planecloud_slam/planecloud_msgs/robot_name.h"

namespace planecloud {
namespace {

constexpr int kTicksPerInputReport = 5;

double seconds(const ros::WallTime& since) { return (ros::WallTime::now() - since).toSec(); }

std::string checkedRobotName(const std::string& name, const std::string& name_space) {
  const std::string robot = robotName(name, name_space);
  checkRobotName(robot);
  return robot;
}

}  // namespace

FrontendNode::FrontendNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                           const FrontendNodeOptions& options)
    : options_(options),
      live_options_(private_node, options),
      robot_(checkedRobotName(options.robot, node.getNamespace())),
      session_(parseSession(options.session, ros::WallTime::now().toNSec())),
      odometry_(options),
      tracker_(options, robot_, session_, odometry_),
      sender_(node, options.link, robot_, session_),
      visual_odometry_(node, options, odometry_),
      preview_(node, options.frontend),
      frames_(static_cast<std::size_t>(options.input.frame_queue)),
      keyframes_(0),
      previews_(1),
      input_(node, private_node, options.input,
             [this](InputFrame frame) { enqueue(std::move(frame)); }) {
  ros::NodeHandle node_handle(node);
  ros::NodeHandle private_handle(private_node);
  diagnostics_ = node_handle.advertise<diagnostic_msgs::DiagnosticArray>("/diagnostics", 10);
  finish_service_ = private_handle.advertiseService("finish", &FrontendNode::onFinish, this);
  timer_ = node_handle.createWallTimer(ros::WallDuration(1.0),
                                       [this](const ros::WallTimerEvent&) { onTimer(); });
  ROS_INFO_STREAM("frontend of robot " << robot_ << ", session " << session_ << ": images are "
                                       << (input_.isRectified() ? "rectified" : "raw"));
  tracking_ = std::thread([this] { trackFrames(); });
  fitting_ = std::thread([this] { fitKeyframes(); });
  previewing_ = std::thread([this] { previewFrames(); });
  input_.start();
}

FrontendNode::~FrontendNode() {
  timer_.stop();
  finish_service_.shutdown();
  frames_.close();  // wakes the input if it waits for room
  input_.stop();
  tracking_.join();
  keyframes_.close();
  previews_.close();
  fitting_.join();
  previewing_.join();
}

void FrontendNode::finish() {
  input_.stop();
  const auto timeout = std::chrono::duration<double>(options_.shutdown_timeout);
  if (requestFinish().wait_for(timeout) != std::future_status::ready) {
    ROS_WARN("the last keyframe was not finished in time: raise ~shutdown_timeout");
    return;
  }
  const std::size_t missing = sender_.flush(options_.shutdown_timeout);
  if (missing == 0) return;
  ROS_WARN_STREAM(missing << " keyframes are not acknowledged by every backend heard lately");
}

void FrontendNode::enqueue(InputFrame frame) {
  TrackingTask task{std::move(frame), nullptr};
  if (!options_.input.drop_frames) {
    frames_.push(std::move(task));
    return;
  }
  const std::size_t dropped = frames_.pushDroppingOldest(std::move(task));
  if (dropped == 0) return;
  counters_.dropped += dropped;
  log_.warn("tracking is slower than the camera: " + std::to_string(counters_.dropped) +
            " frames dropped so far; lower the camera's rate or "
            "~tracking/finest_width, or build with CMAKE_BUILD_TYPE=Release");
}

void FrontendNode::trackFrames() {
  while (std::optional<TrackingTask> task = frames_.pop()) {
    if (task->frame) {
      trackFrame(*task->frame);
      continue;
    }
    tracker_.finish();
    has_open_keyframe_ = false;
    passOnCompleted();
    keyframes_.push({std::nullopt, "", std::move(task->finished)});
  }
}

void FrontendNode::trackFrame(const InputFrame& input) {
  const ros::WallTime start = ros::WallTime::now();
  try {
    const FrontendOptions live = live_options_.get().first.frontend;
    tracker_.setKeyframeOptions(live.keyframe);
    TrackedFrame tracked =
        tracker_.track(input, {input_.isRectified(), live.texture.format == TextureFormat::kColor});
    ++counters_.frames;
    counters_.track_time = seconds(start);
    reportLoss(tracked.result);
    passOnCompleted();
    visual_odometry_.publish(tracked);
    if (preview_.isWanted()) previews_.pushDroppingOldest(std::move(tracked));
  } catch (const std::exception& error) {
    ++counters_.unusable;
    log_.error(std::string("frame ignored: ") + error.what());
  }
}

void FrontendNode::reportLoss(const FrameResult& result) {
  is_tracking_ = result.status != TrackingStatus::kLost;
  if (is_tracking_) {
    has_open_keyframe_ = true;
    counters_.segments = std::max(counters_.segments.load(), result.segment + 1);
    if (result.status != TrackingStatus::kRelocalised) return;
    ++counters_.found;
    ROS_INFO_STREAM("tracking found the camera again, at keyframe " << toString(result.reference));
    return;
  }
  ++counters_.lost;
  log_.warn("tracking lost: " + result.reason +
            "; go back to where it was tracked, move slowly and keep 0.5 to 4 m off "
            "(if the images look wrong: check exposure, lens cap and depth stream)");
}

void FrontendNode::passOnCompleted() {
  for (CompletedKeyframe& completed : tracker_.takeCompleted()) {
    keyframes_.push({std::move(completed), tracker_.cameraFrame(), nullptr});
  }
}

void FrontendNode::fitKeyframes() {
  KeyframeCompressor compressor(options_.frontend);
  std::uint64_t known_changes = 0;
  while (std::optional<FittingTask> task = keyframes_.pop()) {
    const auto [options, changes] = live_options_.get();
    if (changes != known_changes) {
      known_changes = changes;
      compressor.setOptions(options.frontend);
    }
    try {
      if (task->keyframe) fitKeyframe(compressor, *task);
    } catch (const std::exception& error) {
      ROS_ERROR_STREAM("keyframe not sent: " << error.what());
    }
    if (task->finished) task->finished->set_value();
  }
}

void FrontendNode::fitKeyframe(KeyframeCompressor& compressor, FittingTask& task) {
  const ros::WallTime start = ros::WallTime::now();
  const Eigen::Isometry3d T_visual_camera = task.keyframe->keyframe.T_odom_camera;
  task.keyframe->keyframe.planes.camera = task.keyframe->camera;
  const KeyframeBudget budget{
      &FitBudget::Clock::now,
      sender_.keyframeAllowance(task.keyframe->keyframe, task.camera_frame)};
  Keyframe keyframe = compressor.compress(std::move(*task.keyframe), budget);
  counters_.fit_time = seconds(start);
  keyframe.T_odom_camera =
      odometry_.keyframePose(task.camera_frame, keyframe.stamp, T_visual_camera);
  sendKeyframe(std::move(keyframe), task.camera_frame);
}

void FrontendNode::sendKeyframe(Keyframe keyframe, const std::string& camera_frame) {
  const std::size_t bytes = keyframe.planes.bytes.size() + keyframe.texture.bytes.size();
  sender_.send(std::move(keyframe), camera_frame);
  ++counters_.keyframes;
  counters_.bytes += bytes;
}

void FrontendNode::previewFrames() {
  while (std::optional<TrackedFrame> tracked = previews_.pop()) {
    preview_.publish(std::move(*tracked));
  }
}

std::future<void> FrontendNode::requestFinish() {
  auto finished = std::make_shared<std::promise<void>>();
  std::future<void> future = finished->get_future();
  frames_.push({std::nullopt, std::move(finished)});
  return future;
}

bool FrontendNode::onFinish(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  std::future<void> finished = requestFinish();
  try {
    finished.get();
    response.success = true;
    response.message = std::to_string(counters_.keyframes) + " keyframes sent";
  } catch (const std::future_error&) {
    response.message = "frames keep coming: stop the camera or the bag first";
  }
  return true;
}

void FrontendNode::onTimer() {
  if (++ticks_ % kTicksPerInputReport == 0) input_.reportProblems();
  const double patience = options_.input.idle_timeout;
  if (patience > 0.0 && has_open_keyframe_ && input_.silence() > patience && frames_.size() == 0) {
    ROS_INFO_STREAM("no images for " << patience << " s: the open keyframe is completed");
    has_open_keyframe_ = false;
    frames_.push({std::nullopt, std::make_shared<std::promise<void>>()});
  }
  sender_.setRate(live_options_.get().first.link.bytes_per_second);
  publishDiagnostics();
}

void FrontendNode::publishDiagnostics() {
  const OutboxStatistics link = sender_.statistics();
  DiagnosticStatus status(ros::this_node::getName(), "tracking", robot_);
  if (counters_.frames > 0 && !is_tracking_) status.warn("lost");
  if (counters_.frames == 0) status.warn("no frames");
  status.add("camera rate [Hz]", input_.rate());
  status.add("frames", counters_.frames);
  status.add("frames dropped", counters_.dropped);
  status.add("frames lost", counters_.lost);
  status.add("times found again", counters_.found);
  status.add("segments", counters_.segments.load());
  status.add("frames unusable", counters_.unusable);
  status.add("tracking time [s]", counters_.track_time);
  status.add("fit time [s]", counters_.fit_time);
  status.add("keyframes", counters_.keyframes);
  status.add("plane and texture bytes", counters_.bytes);
  status.add("backends", link.backends);
  status.add("keyframes waiting for the link", sender_.waiting());
  status.add("keyframes kept", link.stored);
  status.add("bytes kept", link.stored_bytes);
  status.add("keyframes unacknowledged", link.unacknowledged);
  status.add("keyframes sent again", link.resent);
  status.add("keyframes given up", link.given_up);
  status.add("keyframes forgotten", link.forgotten);
  diagnostics_.publish(status.toMessage());
}

}  // namespace planecloud

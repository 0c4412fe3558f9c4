// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/ros.h>
#include <std_srvs/Trigger.h>

#include <atomic>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "planecloud_slam/frontend_node/frame_publisher.h"
#include "planecloud_slam/frontend_node/frame_tracker.h"
#include "planecloud_slam/frontend_node/frontend_node_options.h"
#include "planecloud_slam/frontend_node/keyframe_compressor.h"
#include "planecloud_slam/frontend_node/keyframe_sender.h"
#include "planecloud_slam/frontend_node/live_options.h"
#include "planecloud_slam/frontend_node/odometry_source.h"
#include "planecloud_slam/frontend_node/rgbd_input.h"
#include "planecloud_slam/plane_fit/bounded_queue.h"
#include "planecloud_slam/planecloud_msgs/log_throttle.h"

namespace planecloud {

/// The frontend as a ROS node: images in, keyframes out. Three threads in a row, none of which
/// waits for the next one: tracking, fitting keyframes, fitting live frames for whoever looks.
class FrontendNode {
 public:
  /// Throws std::invalid_argument for options that cannot be.
  FrontendNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
               const FrontendNodeOptions& options);
  ~FrontendNode();

  /// Completes the open keyframe and waits until it is sent and acknowledged, at most
  /// `~shutdown_timeout`; callbacks must be served by another thread.
  void finish();

 private:
  /// Work for the tracker: a frame, or without one the end of the recording.
  struct TrackingTask {
    std::optional<InputFrame> frame;
    std::shared_ptr<std::promise<void>> finished;
  };
  /// Work for the fitter: a keyframe, or without one a mark that all before it were sent.
  struct FittingTask {
    std::optional<CompletedKeyframe> keyframe;
    std::string camera_frame;
    std::shared_ptr<std::promise<void>> finished;
  };
  struct Counters {
    std::atomic<std::size_t> frames{0}, dropped{0}, lost{0}, found{0}, unusable{0}, keyframes{0},
        bytes{0};
    std::atomic<int> segments{0};
    std::atomic<double> track_time{0.0}, fit_time{0.0};  ///< of the last one [s]
  };

  void enqueue(InputFrame frame);
  void trackFrames();
  void trackFrame(const InputFrame& input);
  void reportLoss(const FrameResult& result);
  void passOnCompleted();
  void fitKeyframes();
  void fitKeyframe(KeyframeCompressor& compressor, FittingTask& task);
  void sendKeyframe(Keyframe keyframe, const std::string& camera_frame);
  void previewFrames();

  /// Completes the open keyframe; the future is ready when it was sent.
  std::future<void> requestFinish();
  bool onFinish(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  void onTimer();
  void publishDiagnostics();

  const FrontendNodeOptions options_;
  const LiveOptions live_options_;
  const std::string robot_;
  const std::uint64_t session_;
  LogThrottle log_;
  Counters counters_;
  std::atomic<bool> has_open_keyframe_{false};
  std::atomic<bool> is_tracking_{false};

  OdometrySource odometry_;
  FrameTracker tracker_;
  KeyframeSender sender_;
  VisualOdometryPublisher visual_odometry_;
  PlanePreviewPublisher preview_;
  BoundedQueue<TrackingTask> frames_;
  BoundedQueue<FittingTask> keyframes_;
  BoundedQueue<TrackedFrame> previews_;
  RgbdInput input_;

  ros::Publisher diagnostics_;
  ros::ServiceServer finish_service_;
  ros::WallTimer timer_;
  int ticks_ = 0;
  std::thread tracking_;
  std::thread fitting_;
  std::thread previewing_;
};

}  // namespace planecloud

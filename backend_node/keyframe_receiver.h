// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <planecloud_slam/PlaneCloudKeyframe.h>
#include <ros/ros.h>

#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "planecloud_slam/backend_node/ack_tracker.h"
#include "planecloud_slam/backend_node/backend_node_options.h"
#include "planecloud_slam/planecloud_msgs/log_throttle.h"

namespace planecloud {

/// Hears the `keyframes` of all robots, refuses malformed ones and acknowledges on `keyframe_acks`
/// what is settled.
class KeyframeReceiver {
 public:
  /// Called with each sound, new keyframe and the index of its source, from callbacks of ROS.
  using OnKeyframe = std::function<void(Keyframe, std::size_t)>;

  KeyframeReceiver(const ros::NodeHandle& node, const BackendNodeOptions& options,
                   OnKeyframe on_keyframe);

  /// The keyframe is in the map, or refused for good. Safe from any thread.
  void settle(std::size_t source, const KeyframeId& id);

  [[nodiscard]] std::size_t malformed() const { return malformed_; }
  [[nodiscard]] std::size_t repeated() const { return repeated_; }
  /// Keyframes missing before others.
  [[nodiscard]] std::size_t missing() const;

 private:
  struct Source {
    std::string name_space;
    ros::Subscriber keyframes;
    ros::Publisher acks;
    AckTracker tracker;
    bool has_news = true;
    ros::WallTime last_ack;
  };

  void listen(ros::NodeHandle node, const std::string& name_space);
  void onMessage(const planecloud_slam::PlaneCloudKeyframe& message, std::size_t source);
  void reportGap(const KeyframeId& id, std::int64_t expected);
  void refuse(const planecloud_slam::PlaneCloudKeyframe& message, std::size_t source,
              const std::string& reason);
  void acknowledgeAll();
  void acknowledge(Source& source) const;

  const std::string backend_id_;
  const ros::WallDuration ack_period_;
  const OnKeyframe on_keyframe_;
  LogThrottle log_;
  std::atomic<std::size_t> malformed_{0};
  std::atomic<std::size_t> repeated_{0};
  mutable std::mutex mutex_;
  std::vector<std::unique_ptr<Source>> sources_;
  ros::WallTimer timer_;
};

}  // namespace planecloud

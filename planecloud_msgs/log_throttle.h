// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/console.h>
#include <ros/time.h>

#include <map>
#include <mutex>
#include <string>

namespace planecloud_slam {

/// Says the same thing once per `period` by the wall clock: rosconsole's own throttle stands still
/// with simulated time. Safe to use from several threads.
class LogThrottle {
 public:
  explicit LogThrottle(double period = 10.0) : period_(period) {}

  /// True when nothing was said about `topic` for a while.
  [[nodiscard]] bool allows(const std::string& topic) {
    const std::lock_guard<std::mutex> lock(mutex_);
    const ros::WallTime now = ros::WallTime::now();
    const auto [said, is_new] = said_.try_emplace(topic, now);
    if (is_new) return true;
    if (now - said->second < period_) return false;
    said->second = now;
    return true;
  }

  void warn(const std::string& topic, const std::string& text) {
    if (allows(topic)) ROS_WARN_STREAM(text);
  }
  void error(const std::string& topic, const std::string& text) {
    if (allows(topic)) ROS_ERROR_STREAM(text);
  }

 private:
  const ros::WallDuration period_;
  std::mutex mutex_;
  std::map<std::string, ros::WallTime> said_;
};

}  // namespace planecloud_slam

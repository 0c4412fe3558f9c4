// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/console.h>
#include <ros/time.h>

#include <algorithm>
#include <cctype>
#include <iterator>
#include <map>
#include <mutex>
#include <string>

namespace planecloud {

/// Says the same thing once per `period` [s] by the wall clock: rosconsole's own throttle stands
/// still with simulated time. Texts that differ in their numbers alone are the same, unless
/// `about`, what they are about, differs. Safe to use from several threads.
class LogThrottle {
 public:
  explicit LogThrottle(double period = 10.0) : period_(period) {}

  void info(const std::string& text, const std::string& about = "") {
    if (allows(text, about)) ROS_INFO_STREAM(text);
  }
  void warn(const std::string& text, const std::string& about = "") {
    if (allows(text, about)) ROS_WARN_STREAM(text);
  }
  void error(const std::string& text, const std::string& about = "") {
    if (allows(text, about)) ROS_ERROR_STREAM(text);
  }

 private:
  /// More texts than this are forgotten: some may carry bytes from the network.
  static constexpr std::size_t kMaxTexts = 1000;

  bool allows(const std::string& text, const std::string& about) {
    std::string key = about + "\n";
    std::copy_if(text.begin(), text.end(), std::back_inserter(key),
                 [](unsigned char c) { return std::isdigit(c) == 0; });
    const std::lock_guard<std::mutex> lock(mutex_);
    if (said_.size() > kMaxTexts) said_.clear();
    const ros::WallTime now = ros::WallTime::now();
    const auto [said, is_new] = said_.try_emplace(key, now);
    if (is_new) return true;
    if (now - said->second < period_) return false;
    said->second = now;
    return true;
  }

  const ros::WallDuration period_;
  std::mutex mutex_;
  std::map<std::string, ros::WallTime> said_;
};

}  // namespace planecloud

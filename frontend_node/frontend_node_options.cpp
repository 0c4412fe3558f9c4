// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/frontend_node/frontend_node_options.h"

#include <algorithm>
#include <stdexcept>

namespace planecloud {

std::string toString(RectifyMode mode) {
  switch (mode) {
    case RectifyMode::kAuto:
      return "auto";
    case RectifyMode::kNever:
      return "never";
    case RectifyMode::kAlways:
      return "always";
  }
  throw std::invalid_argument("unknown rectify mode");
}

void fromString(const std::string& text, RectifyMode& mode) {
  for (const RectifyMode choice : {RectifyMode::kAuto, RectifyMode::kNever, RectifyMode::kAlways}) {
    if (toString(choice) != text) continue;
    mode = choice;
    return;
  }
  throw std::invalid_argument("rectify = " + text + ": must be one of auto, never, always");
}

void InputOptions::check() const {
  checkRange("max_interval", max_interval, 0.0, 1.0);
  checkRange("subscriber_queue", subscriber_queue, 1, 100000);
  checkRange("sync_queue", sync_queue, 1, 100000);
  checkRange("frame_queue", frame_queue, 1, 100000);
  checkRange("idle_timeout", idle_timeout, 0.0, 3600.0);
}

void FrontendNodeOptions::check() const {
  static_cast<void>(parseSession(session, 1));
  if (base_frame.empty()) throw std::invalid_argument("base_frame = : must be the name of a frame");
  if (publish_odom_tf && !guess_frame.empty() && guess_frame == odom_frame) {
    throw std::invalid_argument("guess_frame = " + guess_frame +
                                ": must be the wheels' frame, not the one that publish_odom_tf "
                                "fills with visual odometry");
  }
  checkRange("tf_wait", tf_wait, 0.0, 5.0);
  checkRange("shutdown_timeout", shutdown_timeout, 0.0, 60.0);
  input.check();
  link.check();
  frontend.check();
}

std::uint64_t parseSession(const std::string& text, std::uint64_t now) {
  if (text.empty()) return now;
  const bool digits = text.find_first_not_of("0123456789") == std::string::npos;
  if (!digits || text.size() > 19 || std::stoull(text) == 0) {
    throw std::invalid_argument("session = " + text + ": must be in [1, 9999999999999999999]");
  }
  return std::stoull(text);
}

std::string robotName(const std::string& name, const std::string& name_space) {
  if (!name.empty()) return name;
  const std::size_t first = name_space.find_first_not_of('/');
  if (first == std::string::npos) return "robot";
  std::string result = name_space.substr(first);
  std::replace(result.begin(), result.end(), '/', '_');
  return result;
}

}  // namespace planecloud

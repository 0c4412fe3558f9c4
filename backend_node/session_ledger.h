// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "planecloud_slam/plane_fit/keyframe.h"

namespace planecloud {

/// Tells a restarted frontend from two robots that go by one name. After a restart only the newer
/// session makes new keyframes; the older one may still deliver what it made before. Two sessions
/// that both go on are a name clash.
class SessionLedger {
 public:
  /// Empty when `keyframe` fits its robot's sessions, else a text that names the two that clash.
  [[nodiscard]] std::string clash(const Keyframe& keyframe) const;

  /// Takes note of a keyframe that entered the map.
  void record(const Keyframe& keyframe);

  void clear() { sessions_.clear(); }

 private:
  struct Session {
    double first_stamp = 0.0;  ///< earliest seen [s]
    std::uint32_t last_number = 0;
  };
  /// By robot, then by session, oldest first.
  std::map<std::string, std::map<std::uint64_t, Session>> sessions_;
};

}  // namespace planecloud

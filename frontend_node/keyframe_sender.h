// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <planecloud_slam/KeyframeAck.h>
#include <ros/ros.h>

#include <cstdint>
#include <mutex>
#include <string>

#include "planecloud_slam/frontend_node/outbox.h"

namespace planecloud {

/// Publishes `keyframes`, listens to `keyframe_acks` and sends again what backends miss.
class KeyframeSender {
 public:
  KeyframeSender(ros::NodeHandle node, const LinkOptions& options, const std::string& robot,
                 std::uint64_t session);

  /// Safe from any thread. Throws std::invalid_argument for a keyframe that no message can carry.
  void send(Keyframe keyframe, const std::string& camera_frame);

  [[nodiscard]] OutboxStatistics statistics() const;

  /// Waits until every backend heard has everything, at most `seconds`; callbacks must be served
  /// by another thread. Returns the number of keyframes still missing somewhere.
  std::size_t flush(double seconds) const;

 private:
  void onAck(const planecloud_slam::KeyframeAck& message);
  void resend();

  std::string camera_frame_;
  mutable std::mutex mutex_;
  Outbox outbox_;
  std::size_t given_up_ = 0;
  ros::Publisher publisher_;
  ros::Subscriber acks_;
  ros::WallTimer timer_;
};

}  // namespace planecloud

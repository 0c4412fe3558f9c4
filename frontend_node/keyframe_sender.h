// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <planecloud_slam/KeyframeAck.h>
#include <planecloud_slam/PlaneCloudKeyframe.h>
#include <ros/ros.h>

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "planecloud_slam/frontend_node/link_budget.h"
#include "planecloud_slam/frontend_node/outbox.h"

namespace planecloud {

/// Publishes `keyframes` at the rate the link allows, listens to `keyframe_acks` and sends again
/// what backends miss.
class KeyframeSender {
 public:
  KeyframeSender(ros::NodeHandle node, const LinkOptions& options, const std::string& robot,
                 std::uint64_t session);

  /// Sends a keyframe, or lets it wait in line for room on the link. Safe from any thread.
  /// Throws std::invalid_argument for a keyframe that no message can carry.
  void send(Keyframe keyframe, const std::string& camera_frame);

  /// Bytes for planes and texture of a keyframe that should go now; none: no limit. Half of what
  /// the link has left, so that keyframes in quick succession get less each, not nothing.
  [[nodiscard]] std::optional<std::size_t> keyframeAllowance(const Keyframe& keyframe,
                                                             const std::string& camera_frame);

  /// See LinkOptions::bytes_per_second.
  void setRate(double bytes_per_second);

  [[nodiscard]] OutboxStatistics statistics() const;
  /// Keyframes that wait for room on the link.
  [[nodiscard]] std::size_t waiting() const;

  /// Waits until every backend heard has everything, at most `seconds`; callbacks must be served
  /// by another thread. Returns the number of keyframes still missing somewhere.
  std::size_t flush(double seconds) const;

 private:
  struct Waiting {
    std::shared_ptr<const Keyframe> keyframe;
    planecloud_slam::PlaneCloudKeyframe message;
    std::size_t bytes;
  };

  void onAck(const planecloud_slam::KeyframeAck& message);
  void onTimer();
  void sendWaiting();
  void resend();
  void reportGivenUp();

  std::string camera_frame_;
  mutable std::mutex mutex_;
  Outbox outbox_;
  LinkBudget budget_;
  std::deque<Waiting> waiting_;
  std::size_t waiting_bytes_ = 0;
  std::size_t given_up_ = 0;
  ros::Publisher publisher_;
  ros::Subscriber acks_;
  ros::WallTimer timer_;
};

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/frontend_node/keyframe_sender.h"

#include <memory>
#include <utility>
#include <vector>

#include "planecloud_slam/planecloud_msgs/conversions.h"

namespace planecloud {
namespace {

constexpr double kResendPeriod = 0.2;  // [s]
/// Without limit: what a slow link cannot take yet must not be dropped.
constexpr std::uint32_t kPublisherQueue = 0;
constexpr std::uint32_t kAckQueue = 100;

double monotonicNow() { return ros::SteadyTime::now().toSec(); }

KeyframeReceipt toReceipt(const planecloud_slam::KeyframeAck& message) {
  return {message.backend_id,          message.robot,   message.session,
          message.highest_without_gap, message.highest, message.gaps};
}

}  // namespace

KeyframeSender::KeyframeSender(ros::NodeHandle node, const LinkOptions& options,
                               const std::string& robot, std::uint64_t session)
    : outbox_(options, robot, session),
      publisher_(
          node.advertise<planecloud_slam::PlaneCloudKeyframe>("keyframes", kPublisherQueue)) {
  if (!options.acknowledge) return;
  acks_ = node.subscribe("keyframe_acks", kAckQueue, &KeyframeSender::onAck, this,
                         ros::TransportHints().tcpNoDelay());
  timer_ = node.createWallTimer(ros::WallDuration(kResendPeriod),
                                [this](const ros::WallTimerEvent&) { resend(); });
}

void KeyframeSender::send(Keyframe keyframe, const std::string& camera_frame) {
  const planecloud_slam::PlaneCloudKeyframe message = toMessage(keyframe, camera_frame);
  const std::lock_guard<std::mutex> lock(mutex_);
  camera_frame_ = camera_frame;
  outbox_.add(std::make_shared<const Keyframe>(std::move(keyframe)), monotonicNow());
  publisher_.publish(message);
}

void KeyframeSender::onAck(const planecloud_slam::KeyframeAck& message) {
  const std::lock_guard<std::mutex> lock(mutex_);
  outbox_.acknowledge(toReceipt(message), monotonicNow());
}

void KeyframeSender::resend() {
  const std::lock_guard<std::mutex> lock(mutex_);
  for (const std::shared_ptr<const Keyframe>& keyframe : outbox_.takeDue(monotonicNow())) {
    publisher_.publish(toMessage(*keyframe, camera_frame_));
  }
  const std::size_t given_up = outbox_.statistics().given_up;
  if (given_up > given_up_) {
    ROS_WARN_STREAM(given_up - given_up_
                    << " keyframes that no backend ever acknowledged were given up (" << given_up
                    << " so far): start a backend on this topic, or raise "
                       "~link/outbox_bytes and ~link/backend_timeout");
  }
  given_up_ = given_up;
}

OutboxStatistics KeyframeSender::statistics() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return outbox_.statistics();
}

std::size_t KeyframeSender::flush(double seconds) const {
  const double deadline = monotonicNow() + seconds;
  std::size_t missing = statistics().unacknowledged;
  while (missing > 0 && monotonicNow() < deadline) {
    ros::WallDuration(0.02).sleep();
    missing = statistics().unacknowledged;
  }
  return missing;
}

}  // namespace planecloud

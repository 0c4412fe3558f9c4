// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/frontend_node/keyframe_sender.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "planecloud_slam/planecloud_msgs/conversions.h"

namespace planecloud {
namespace {

constexpr double kTimerPeriod = 0.1;  // [s]
/// The least worth sending of planes [B].
constexpr std::size_t kLeastPlanes = 128;
/// Without limit: what a slow link cannot take yet must not be dropped.
constexpr std::uint32_t kPublisherQueue = 0;
constexpr std::uint32_t kAckQueue = 100;

/// On the wire: TCPROS puts the length before each message.
std::size_t wireSize(const planecloud_slam::PlaneCloudKeyframe& message) {
  return ros::serialization::serializationLength(message) + sizeof(std::uint32_t);
}

double monotonicNow() { return ros::SteadyTime::now().toSec(); }

KeyframeReceipt toReceipt(const planecloud_slam::KeyframeAck& message) {
  return {message.backend_id,          message.robot,   message.session,
          message.highest_without_gap, message.highest, message.gaps};
}

}  // namespace

KeyframeSender::KeyframeSender(ros::NodeHandle node, const LinkOptions& options,
                               const std::string& robot, std::uint64_t session)
    : outbox_(options, robot, session),
      budget_(options.bytes_per_second),
      publisher_(
          node.advertise<planecloud_slam::PlaneCloudKeyframe>("keyframes", kPublisherQueue)) {
  timer_ = node.createWallTimer(ros::WallDuration(kTimerPeriod),
                                [this](const ros::WallTimerEvent&) { onTimer(); });
  if (!options.acknowledge) return;
  acks_ = node.subscribe("keyframe_acks", kAckQueue, &KeyframeSender::onAck, this,
                         ros::TransportHints().tcpNoDelay());
}

void KeyframeSender::send(Keyframe keyframe, const std::string& camera_frame) {
  planecloud_slam::PlaneCloudKeyframe message = toMessage(keyframe, camera_frame);
  const std::size_t bytes = wireSize(message);
  const std::lock_guard<std::mutex> lock(mutex_);
  camera_frame_ = camera_frame;
  waiting_bytes_ += bytes;
  waiting_.push_back(
      {std::make_shared<const Keyframe>(std::move(keyframe)), std::move(message), bytes});
  sendWaiting();
}

void KeyframeSender::sendWaiting() {
  const double now = monotonicNow();
  while (!waiting_.empty() && budget_.admits(waiting_.front().bytes, now)) {
    Waiting& next = waiting_.front();
    outbox_.add(std::move(next.keyframe), next.bytes, now);
    publisher_.publish(next.message);
    budget_.spend(next.bytes, now);
    waiting_bytes_ -= next.bytes;
    waiting_.pop_front();
  }
}

std::optional<std::size_t> KeyframeSender::keyframeAllowance(const Keyframe& keyframe,
                                                             const std::string& camera_frame) {
  const std::size_t overhead = wireSize(toMessage(keyframe, camera_frame));
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!budget_.isLimited()) return std::nullopt;
  const std::size_t available = budget_.available(monotonicNow());
  const std::size_t share = (available - std::min(available, waiting_bytes_)) / 2;
  return std::max(kLeastPlanes, share - std::min(share, overhead));
}

void KeyframeSender::setRate(double bytes_per_second) {
  const std::lock_guard<std::mutex> lock(mutex_);
  budget_.setRate(bytes_per_second);
}

void KeyframeSender::onAck(const planecloud_slam::KeyframeAck& message) {
  const std::lock_guard<std::mutex> lock(mutex_);
  outbox_.acknowledge(toReceipt(message), monotonicNow());
}

void KeyframeSender::onTimer() {
  const std::lock_guard<std::mutex> lock(mutex_);
  sendWaiting();
  if (waiting_.empty()) resend();
  reportGivenUp();
}

void KeyframeSender::resend() {
  const double now = monotonicNow();
  for (const auto& keyframe : outbox_.takeDue(now, budget_.available(now))) {
    const planecloud_slam::PlaneCloudKeyframe message = toMessage(*keyframe, camera_frame_);
    budget_.spend(wireSize(message), now);
    publisher_.publish(message);
  }
}

void KeyframeSender::reportGivenUp() {
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

std::size_t KeyframeSender::waiting() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return waiting_.size();
}

std::size_t KeyframeSender::flush(double seconds) const {
  const double deadline = monotonicNow() + seconds;
  std::size_t missing = waiting() + statistics().unacknowledged;
  while (missing > 0 && monotonicNow() < deadline) {
    ros::WallDuration(0.02).sleep();
    missing = waiting() + statistics().unacknowledged;
  }
  return missing;
}

}  // namespace planecloud

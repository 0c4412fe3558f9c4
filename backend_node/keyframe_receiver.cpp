// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/backend_node/keyframe_receiver.h"

#include <planecloud_slam/KeyframeAck.h>

#include <utility>

#include "planecloud_slam/planecloud_msgs/conversions.h"
#include "planecloud_slam/planecloud_msgs/robot_name.h"

namespace planecloud {
namespace {

/// Without limit: the backend drops nothing.
constexpr std::uint32_t kSubscriberQueue = 0;
constexpr std::uint32_t kAckQueue = 10;
/// Least time between two acknowledgements [s].
constexpr double kAckInterval = 0.1;

planecloud_slam::KeyframeAck toMessage(const SessionReceipt& receipt) {
  planecloud_slam::KeyframeAck message;
  message.robot = receipt.robot;
  message.session = receipt.session;
  message.highest_without_gap = receipt.highest_without_gap;
  message.highest = receipt.highest;
  message.gaps = receipt.gaps;
  return message;
}

}  // namespace

KeyframeReceiver::KeyframeReceiver(const ros::NodeHandle& node, const BackendNodeOptions& options,
                                   OnKeyframe on_keyframe)
    : backend_id_(options.backend_id.empty() ? ros::this_node::getName() : options.backend_id),
      ack_period_(options.ack_period),
      on_keyframe_(std::move(on_keyframe)) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const std::vector<std::string> name_spaces = splitWords(options.robots);
  for (const std::string& name_space : name_spaces) listen(node, name_space);
  if (name_spaces.empty()) listen(node, "");
  timer_ = ros::NodeHandle(node).createWallTimer(
      ros::WallDuration(kAckInterval), [this](const ros::WallTimerEvent&) { acknowledgeAll(); });
}

void KeyframeReceiver::listen(ros::NodeHandle node, const std::string& name_space) {
  const std::string prefix = name_space.empty() ? "" : name_space + "/";
  auto source = std::make_unique<Source>();
  const std::size_t index = sources_.size();
  source->name_space = name_space;
  source->acks = node.advertise<planecloud_slam::KeyframeAck>(prefix + "keyframe_acks", kAckQueue);
  source->keyframes = node.subscribe<planecloud_slam::PlaneCloudKeyframe>(
      prefix + "keyframes", kSubscriberQueue,
      [this, index](const planecloud_slam::PlaneCloudKeyframe::ConstPtr& message) {
        onMessage(*message, index);
      },
      ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay());
  ROS_INFO_STREAM("listening to " << source->keyframes.getTopic());
  sources_.push_back(std::move(source));
}

void KeyframeReceiver::onMessage(const planecloud_slam::PlaneCloudKeyframe& message,
                                 std::size_t source) {
  Keyframe keyframe;
  try {
    keyframe = fromMessage(message);
  } catch (const MessageError& error) {
    refuse(message, source, error.what());
    return;
  }
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    sources_[source]->has_news = true;
    AckTracker& tracker = sources_[source]->tracker;
    const std::int64_t expected = tracker.highestArrived(keyframe.id) + 1;
    if (!tracker.noteArrival(keyframe.id)) {
      ++repeated_;
      log_.info("keyframe " + toString(keyframe.id) + " came again and was ignored",
                keyframe.id.robot);
      return;
    }
    if (keyframe.id.number > expected) reportGap(keyframe.id, expected);
  }
  on_keyframe_(std::move(keyframe), source);
}

void KeyframeReceiver::reportGap(const KeyframeId& id, std::int64_t expected) {
  log_.warn("keyframe " + toString(id) + " came before " + std::to_string(id.number - expected) +
                " earlier ones, from " + std::to_string(expected) +
                " on: they are asked for again (the frontend needs ~link/acknowledge)",
            id.robot);
}

void KeyframeReceiver::refuse(const planecloud_slam::PlaneCloudKeyframe& message,
                              std::size_t source, const std::string& reason) {
  ++malformed_;
  const bool has_name = isRobotName(message.robot);
  log_.error(reason, has_name ? message.robot : "");
  if (has_name) settle(source, {message.robot, message.session, message.id});
}

void KeyframeReceiver::settle(std::size_t source, const KeyframeId& id) {
  const std::lock_guard<std::mutex> lock(mutex_);
  sources_[source]->tracker.settle(id);
  sources_[source]->has_news = true;
}

std::size_t KeyframeReceiver::missing() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::size_t count = 0;
  for (const auto& source : sources_) count += source->tracker.missing();
  return count;
}

void KeyframeReceiver::acknowledgeAll() {
  const std::lock_guard<std::mutex> lock(mutex_);
  const ros::WallTime now = ros::WallTime::now();
  for (const auto& source : sources_) {
    if (!source->has_news && now - source->last_ack < ack_period_) continue;
    acknowledge(*source);
    source->has_news = false;
    source->last_ack = now;
  }
}

void KeyframeReceiver::acknowledge(Source& source) const {
  std::vector<SessionReceipt> receipts = source.tracker.receipts();
  // An empty one says that somebody listens, so that late backends get what was sent before.
  if (receipts.empty()) receipts.emplace_back();
  for (const SessionReceipt& receipt : receipts) {
    planecloud_slam::KeyframeAck message = toMessage(receipt);
    message.backend_id = backend_id_;
    source.acks.publish(message);
  }
}

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/frontend_node/input_monitor.h"

#include <algorithm>
#include <iomanip>
#include <sstream>
#include <utility>

namespace planecloud {
namespace {

/// Colour and depth of one moment may arrive out of order by less than this [s].
constexpr double kJump = 1.0;
/// Fewer images of each kind prove nothing about how they pair.
constexpr std::size_t kFew = 5;

}  // namespace

InputMonitor::InputMonitor(std::array<std::string, kTopics> names, double now) : since_(now) {
  for (std::size_t i = 0; i < kTopics; ++i) topics_[i].name = std::move(names[i]);
}

bool InputMonitor::noteMessage(Topic topic, double stamp) {
  TopicState& state = topics_.at(topic);
  ++state.count;
  ++state.total;
  state.last_stamp = stamp;
  if (topic == kCameraInfo) return false;
  const bool jumped = stamp < newest_stamp_ - kJump;
  newest_stamp_ = jumped ? stamp : std::max(newest_stamp_, stamp);
  return jumped;
}

std::string InputMonitor::takeProblem(double now) {
  const double elapsed = std::max(now - since_, 1e-3);
  for (TopicState& topic : topics_) topic.rate = static_cast<double>(topic.count) / elapsed;
  std::string problem = describeSilence();
  if (problem.empty() && pairs_ == 0) problem = describeMismatch();
  for (TopicState& topic : topics_) topic.count = 0;
  pairs_ = 0;
  since_ = now;
  return problem;
}

std::string InputMonitor::describeRates() const {
  std::ostringstream text;
  text << std::fixed << std::setprecision(1);
  for (const TopicState& topic : topics_) {
    text << (&topic == &topics_.front() ? "" : ", ") << topic.name << " " << topic.rate << " Hz";
  }
  return text.str();
}

std::string InputMonitor::describeSilence() const {
  std::string silent;
  for (const TopicState& topic : topics_) {
    // One camera info serves for ever.
    const bool heard = &topic == &topics_[kCameraInfo] ? topic.total > 0 : topic.count > 0;
    if (!heard) silent += (silent.empty() ? "" : " and ") + topic.name;
  }
  if (silent.empty()) return "";
  return "no messages on " + silent + " (" + describeRates() +
         "): start the camera driver, or remap the topics to the names that 'rostopic list' shows";
}

std::string InputMonitor::describeMismatch() const {
  if (topics_[kColor].count < kFew || topics_[kDepth].count < kFew) return "";
  std::ostringstream text;
  text << std::fixed << std::setprecision(3) << "colour and depth images arrive ("
       << describeRates() << ") but never pair up: the latest stamps are "
       << topics_[kDepth].last_stamp - topics_[kColor].last_stamp
       << " s apart; synchronise the driver's streams, switch ~exact_sync off or raise "
          "~max_interval and ~sync_queue";
  return text.str();
}

}  // namespace planecloud

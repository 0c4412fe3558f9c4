// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/planecloud_msgs/robot_name.h"

#include <algorithm>
#include <stdexcept>

namespace planecloud {
namespace {

constexpr std::size_t kMaxRobotName = 64;

bool isNameCharacter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
         c == '-';
}

/// Safe to show: what cannot be in a robot name becomes `?`, and not too long.
std::string printable(const std::string& received) {
  std::string text = received.substr(0, kMaxRobotName);
  std::replace_if(
      text.begin(), text.end(), [](char c) { return !isNameCharacter(c); }, '?');
  return text;
}

}  // namespace

bool isRobotName(const std::string& name) {
  return !name.empty() && name.size() <= kMaxRobotName &&
         std::all_of(name.begin(), name.end(), isNameCharacter);
}

std::string robotNameError(const std::string& name) {
  return "robot name '" + printable(name) +
         "': must be 1 to 64 letters, digits, '_' or '-'; set the frontend's ~robot";
}

void checkRobotName(const std::string& name) {
  if (!isRobotName(name)) throw std::invalid_argument(robotNameError(name));
}

}  // namespace planecloud

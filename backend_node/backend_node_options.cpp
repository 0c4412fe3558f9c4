// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/backend_node/backend_node_options.h"

#include <iterator>
#include <sstream>
#include <stdexcept>

namespace planecloud {

void BackendNodeOptions::check() const {
  if (map_frame.empty()) throw std::invalid_argument("map_frame = : must be the name of a frame");
  if (odom_frame.empty()) {
    throw std::invalid_argument("odom_frame = : must be the name of a frame, such as {robot}/odom");
  }
  checkRange("ack_period", ack_period, 0.1, 60.0);
  checkRange("publish_period", publish_period, 0.1, 60.0);
  checkRange("tf_period", tf_period, 0.01, 10.0);
  checkRange("cloud_resolution", cloud_resolution, 0.005, 1.0);
  checkRange("max_depth", max_depth, 0.5, 50.0);
  checkRange("max_height", max_height, 0.0, 50.0);
  backend.check();
}

std::vector<std::string> splitWords(const std::string& text) {
  std::istringstream stream(text);
  return {std::istream_iterator<std::string>(stream), std::istream_iterator<std::string>()};
}

std::string frameOfRobot(const std::string& pattern, const std::string& robot) {
  constexpr char kPlaceholder[] = "{robot}";
  std::string frame = pattern;
  for (std::size_t at = frame.find(kPlaceholder); at != std::string::npos;
       at = frame.find(kPlaceholder, at + robot.size())) {
    frame.replace(at, sizeof(kPlaceholder) - 1, robot);
  }
  return frame;
}

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace planecloud {

/// A topic of a bag and its message type, e.g. "sensor_msgs/Image".
struct BagTopic {
  std::string name;
  std::string type;
};

/// The topics that make one robot's recording.
struct RobotTopics {
  std::string robot;  ///< the namespace; "robot1" where there is none
  std::string color;
  std::string depth;
  std::string camera_info;   ///< of the colour images
  std::string ground_truth;  ///< empty: none
};

/// Finds the cameras by their topics' names: colour `<camera>/rgb/...` or `<camera>/color/...`,
/// depth `<camera>/depth_registered/...` or `<camera>/depth/...`, as openni2_launch, the Orbbec
/// drivers and the TUM benchmark name them; rectified and registered images go first.
/// Throws std::runtime_error naming `path`, what is missing and the cure.
[[nodiscard]] std::vector<RobotTopics> findRobots(const std::string& path,
                                                  const std::vector<BagTopic>& topics);

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "planecloud_slam/backend_node/backend_options.h"
#include "planecloud_slam/backend_node/map_coloring.h"
#include "planecloud_slam/plane_fit/option_fields.h"

namespace planecloud {

/// Everything the backend node can be told, by the names of its private parameters.
struct BackendNodeOptions {
  /// Namespaces whose `keyframes` it hears, separated by spaces; empty: its own.
  std::string robots;
  std::string backend_id;  ///< unique among the backends a frontend hears; empty: the node's name
  std::string map_frame = "map";
  std::string odom_frame = "{robot}/odom";  ///< `{robot}` stands for the robot's name
  /// Robots whose odometry frame it hangs on the map by tf, separated by spaces; empty: all. Where
  /// every robot has a backend of its own, each names its own robot: a frame has one parent.
  std::string tf_robots;
  double ack_period = 1.0;      ///< between acknowledgements when nothing arrives [s], [0.1, 60]
  double publish_period = 1.0;  ///< least time between two maps [s], [0.1, 60]
  /// Between two broadcasts of the map's transforms [s], [0.01, 10]; each is valid until the next.
  /// They go to every listener of tf, robots behind a poor link as well.
  double tf_period = 1.0;
  double cloud_resolution = 0.05;  ///< grid of `map_cloud` [m], [0.005, 1]
  double max_depth = 6.0;          ///< tiles beyond are not shown [m], [0.5, 50]
  double max_height = 1.2;         ///< tiles higher above their keyframe are not shown [m], [0, 50]
  MapColoring map_coloring = MapColoring::kRobot;  ///< of `plane_map` and `map_cloud`
  BackendOptions backend;

  template <typename Self, typename Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("robots", self.robots);
    visit("backend_id", self.backend_id);
    visit("map_frame", self.map_frame);
    visit("odom_frame", self.odom_frame);
    visit("tf_robots", self.tf_robots);
    visit("ack_period", self.ack_period);
    visit("publish_period", self.publish_period);
    visit("tf_period", self.tf_period);
    visit("cloud_resolution", self.cloud_resolution);
    visit("max_depth", self.max_depth);
    visit("max_height", self.max_height);
    visit("map_coloring", self.map_coloring);
    BackendOptions::fields(self.backend, visit);
  }
  /// Throws std::invalid_argument naming key, value and range.
  void check() const;
};

/// The words of `text`.
[[nodiscard]] std::vector<std::string> splitWords(const std::string& text);

/// `pattern` with every `{robot}` replaced by `robot`.
[[nodiscard]] std::string frameOfRobot(const std::string& pattern, const std::string& robot);

}  // namespace planecloud

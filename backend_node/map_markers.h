// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nav_msgs/Path.h>
#include <std_msgs/Header.h>
#include <visualization_msgs/MarkerArray.h>

#include <Eigen/Geometry>
#include <map>
#include <string>

#include "planecloud_slam/backend_node/keyframe_colors.h"
#include "planecloud_slam/backend_node/map_snapshot.h"
#include "planecloud_slam/backend_node/robot_colors.h"

namespace planecloud {

/// What of the plane map is shown.
struct PlaneMapView {
  double max_depth = 6.0;   ///< tiles that reach further from their keyframe are left out [m]
  double max_height = 1.2;  ///< and those higher above it: ceilings hide the rest [m]
  MapColoring coloring = MapColoring::kRobot;
};

/// The plane map for rviz, a marker for each keyframe, coloured by robot or texture. Remembers what
/// it has made, so that only what changed travels again.
class PlaneMapMarkers {
 public:
  explicit PlaneMapMarkers(const PlaneMapView& view) : view_(view) {}

  /// Markers that are new or have moved since the last call; after `forget`, or when keyframes
  /// vanished, all of them, with an order to delete the old ones first.
  [[nodiscard]] visualization_msgs::MarkerArray update(const MapSnapshot& snapshot,
                                                       const std_msgs::Header& header);

  /// Somebody new is looking: makes everything again next time.
  void forget() { shown_.clear(), begins_ = true; }

 private:
  struct Shown {
    int id = 0;
    Eigen::Isometry3d T_map_camera;
    bool joined = false;
  };

  [[nodiscard]] bool isUpToDate(const MapSnapshot::Node& node) const;
  [[nodiscard]] visualization_msgs::Marker makeMarker(const MapSnapshot::Node& node,
                                                      const RobotColor& color) const;

  PlaneMapView view_;
  std::map<KeyframeId, Shown> shown_;
  bool begins_ = true;
};

/// The pose graph for rviz: keyframes as spheres, edges as lines; odometry in the robot's colour,
/// the frontend's other edges thin, closures bright (red, between robots magenta), coplanar ones
/// teal.
[[nodiscard]] visualization_msgs::MarkerArray makeGraphMarkers(const MapSnapshot& snapshot,
                                                               const std_msgs::Header& header);

/// The newest candidates that are no closures for rviz: thin red lines, a namespace for each
/// reason, so that each can be shown alone. Deletes the ones sent before.
[[nodiscard]] visualization_msgs::MarkerArray makeRejectedMarkers(const MapSnapshot& snapshot,
                                                                  const std_msgs::Header& header);

/// Keyframe poses by robot, oldest first; only those whose relation to the map is known.
[[nodiscard]] std::map<std::string, nav_msgs::Path> makePaths(const MapSnapshot& snapshot,
                                                              const std_msgs::Header& header);

}  // namespace planecloud

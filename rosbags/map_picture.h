// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "planecloud_slam/backend_node/map_snapshot.h"
#include "planecloud_slam/rosbags/closure_judge.h"
#include "planecloud_slam/rosbags/recording.h"

namespace planecloud {

/// One robot's ways in the frame of the map.
struct PictureRobot {
  std::string name;
  Trajectory optimised;
  Trajectory odometry;      ///< laid on the start of `optimised`
  Trajectory ground_truth;  ///< empty: unknown
};

/// What a picture of a map shows.
struct MapPicture {
  std::string title;
  std::string subtitle;
  std::vector<PictureRobot> robots;
  std::vector<JudgedClosure> closures;
  /// Turns the map so that z is up.
  Eigen::Isometry3d T_view_map = Eigen::Isometry3d::Identity();
};

/// The map from above, 8UC3, blue first: floor and furniture in the robots' colours, walls dark,
/// ways and loop closures over it, with scale bar and legend. Walls are turned parallel to the
/// picture's sides, its long side lies. Shows the component with most keyframes.
[[nodiscard]] cv::Mat drawMap(const MapSnapshot& map, const MapPicture& picture);

}  // namespace planecloud

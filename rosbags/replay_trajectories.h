// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "planecloud_slam/rosbags/recording.h"
#include "planecloud_slam/rosbags/replay_run.h"

namespace planecloud {

/// What is known of one robot's way. Poses of the optical frame, ordered by stamp.
struct RobotTrajectories {
  Trajectory frames;     ///< every tracked frame, moved with its keyframe by the optimisation (map)
  Trajectory keyframes;  ///< optimised (map)
  Trajectory odometry;   ///< every tracked frame, tracking only (odom)
  double path_length = 0.0;  ///< travelled by odometry [m]
};

/// Lost frames, and frames whose keyframe is not in the map, are left out of what is in the map.
[[nodiscard]] RobotTrajectories extractTrajectories(const RobotLog& log, const MapSnapshot& map);

}  // namespace planecloud

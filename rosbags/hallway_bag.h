// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

#include "planecloud_slam/rosbags/hallway_recording.h"

namespace planecloud {

/// How a run of the built-in world becomes a bag.
struct HallwayBagOptions {
  HallwayOptions world;  ///< `robot` is ignored: all robots are written
  /// rgb8 instead of mono8 images. The frontend tracks grey levels; colour costs half as much again
  /// on the disk, more than 500 MB per minute and robot.
  bool color = false;
};

/// Writes what the robots of a run record in the built-in world: images and camera info under
/// `rectifiedTopics`, tf_static (base_footprint -> base_link -> camera_link ->
/// camera_rgb_optical_frame), wheel odometry on `odom` and on tf (odom -> base_footprint), and
/// `ground_truth`. With several robots topics and frames stand in the namespaces robot1, robot2,
/// ... `progress` is called once per image pair. Throws std::invalid_argument for options out of
/// range, std::runtime_error naming the file when it cannot be written.
void writeHallwayBag(const HallwayBagOptions& options, const std::string& path,
                     const std::function<void()>& progress = {});

}  // namespace planecloud

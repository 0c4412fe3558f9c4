// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "planecloud_slam/rosbags/recording.h"

namespace planecloud {

/// Reads a trajectory in the TUM format, `stamp tx ty tz qx qy qz qw` a line [s, m, unit
/// quaternion], lines that start with # ignored. Ordered by stamp. Throws std::runtime_error
/// naming file, line and what was expected.
[[nodiscard]] Trajectory readTrajectory(const std::string& path);

/// Writes what `readTrajectory` reads: stamps to the microsecond, positions to the micrometre.
/// Throws std::runtime_error when the file cannot be written.
void writeTrajectory(const std::string& path, const Trajectory& trajectory);

}  // namespace planecloud

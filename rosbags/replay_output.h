// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "planecloud_slam/rosbags/replay_report.h"

namespace planecloud {

/// Writes a replay into `folder`, which is made: per robot <robot>_frames.txt, _keyframes.txt
/// (optimised), _odometry.txt and, where known, _groundtruth.txt in the TUM format; map.ply,
/// map.png, report.json. Throws std::runtime_error when a file cannot be written.
void writeReplay(const std::string& folder, const JudgedReplay& replay);

}  // namespace planecloud

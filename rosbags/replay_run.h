// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "planecloud_slam/backend_node/backend.h"
#include "planecloud_slam/backend_node/backend_options.h"
#include "planecloud_slam/rosbags/recording.h"
#include "planecloud_slam/rosbags/robot_replay.h"

namespace planecloud {

/// How to replay.
struct ReplayOptions {
  RobotReplayOptions robots;  ///< time budgets are ignored: they would break determinism
  BackendOptions backend;
  int threads = 1;                         ///< at most this many; the result does not depend on it
  std::function<void()> on_frame = [] {};  ///< called after each frame (progress)
  std::function<void(const std::string&)> on_note = [](const std::string&) {};  ///< for people
};

/// What one robot's frontend did.
struct RobotLog {
  std::string robot;
  std::vector<FrameResult> frames;     ///< all of them, lost ones too
  std::vector<double> track_times;     ///< per frame [s]
  std::vector<double> fit_times;       ///< per keyframe [s]
  std::vector<double> keyframe_bytes;  ///< per keyframe on the wire [B]
  Trajectory ground_truth;             ///< empty: unknown
};

/// What a replay made.
struct ReplayResult {
  std::vector<RobotLog> robots;  ///< in the order of the recordings
  std::shared_ptr<const MapSnapshot> map;
  BackendStatistics statistics;
  /// Backend calls that optimised, the last one over the whole graph [s].
  std::vector<double> optimize_times;
  double backend_time = 0.0;  ///< of all its calls [s]
};

/// Both sides in one process: every frame tracked, every keyframe fitted, coded, rounded as if it
/// travelled, and inserted, in the order of the stamps whatever the number of threads.
/// Throws what the recordings throw and std::invalid_argument for options that fail their check.
[[nodiscard]] ReplayResult runReplay(const std::vector<std::shared_ptr<Recording>>& recordings,
                                     ReplayOptions options);

}  // namespace planecloud

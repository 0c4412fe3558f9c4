// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "frame_set.h"
#include "planecloud_slam/frontend_node/frontend.h"
#include "planecloud_slam/rosbags/trajectory_evaluation.h"

/// The parts of bench_tracking.
namespace planecloud::bench {

/// What one run of a tracker over a frame set made.
struct TrackingRun {
  std::vector<FrameResult> frames;
  std::vector<Keyframe> keyframes;  ///< as completed, history edges included
  std::vector<double> track_times;  ///< CPU time per frame [s]
  double keyframe_time = 0.0;       ///< CPU time of fitting, encoding and history [s]
  double sending_bytes = 0.0;       ///< of the keyframes on the wire
};

/// Runs one frontend over `set`, with the wheels as guess when asked for.
[[nodiscard]] TrackingRun track(const FrameSet& set, const FrontendOptions& options,
                                bool use_wheels = false);

/// Errors of the odometry, lost frames left out.
[[nodiscard]] TrajectoryErrors odometryErrors(const FrameSet& set, const TrackingRun& run);

/// ATE and RPE of frontend and backend together, keyframes optimised.
[[nodiscard]] TrajectoryErrors systemErrors(const std::shared_ptr<const FrameSet>& set,
                                            const FrontendOptions& options);

/// The spacings over which figures are averaged [m]: a single ATE is close to chaotic.
[[nodiscard]] const std::vector<double>& spacings();

/// Way along a trajectory [m].
[[nodiscard]] double pathLength(const Trajectory& trajectory);

using FrameSets = std::vector<std::shared_ptr<const FrameSet>>;

/// Time and accuracy against cv::rgbd::RgbdOdometry on the same frames.
void comparePeer(const FrameSets& sets, const FrontendOptions& options);
/// Means over the spacings with each switch turned, tracking alone and the whole system.
void runAblation(const FrameSets& sets, const FrontendOptions& options, bool default_only);
/// The trials of loss: `seeds` of them in the built-in world, a quarter of that in each input.
void runTrials(const std::vector<std::string>& inputs, const FrontendOptions& options, int seeds);
/// Normalised errors squared of odometry and history edges.
void judgeInformation(const FrameSets& sets, const FrontendOptions& options);

}  // namespace planecloud::bench

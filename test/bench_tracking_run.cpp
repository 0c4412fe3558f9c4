// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <utility>

#include "bench_tracking.h"
#include "planecloud_slam/frontend_node/keyframe_compressor.h"
#include "planecloud_slam/plane_fit/keyframe_rounding.h"
#include "planecloud_slam/rosbags/keyframe_wire_size.h"
#include "planecloud_slam/rosbags/replay_run.h"
#include "planecloud_slam/rosbags/replay_trajectories.h"
#include "thread_time.h"

namespace planecloud::bench {
namespace {

constexpr std::uint64_t kSession = 1;

/// Fits and sends what is completed.
void compressCompleted(Frontend& frontend, KeyframeCompressor& compressor, TrackingRun& run) {
  for (CompletedKeyframe& completed : frontend.takeCompleted()) {
    const double start = threadTime();
    Keyframe keyframe = asTravelled(compressor.compress(std::move(completed)));
    run.keyframe_time += threadTime() - start;
    run.sending_bytes += static_cast<double>(keyframeWireSize(keyframe));
    run.keyframes.push_back(std::move(keyframe));
  }
}

}  // namespace

double pathLength(const Trajectory& trajectory) {
  double length = 0.0;
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    length += (trajectory[i].pose.translation() - trajectory[i - 1].pose.translation()).norm();
  }
  return length;
}

const std::vector<double>& spacings() {
  static const std::vector<double> values = {0.15, 0.20, 0.25, 0.30};
  return values;
}

TrackingRun track(const FrameSet& set, const FrontendOptions& options, bool use_wheels) {
  Frontend frontend(options, set.camera, "robot1", kSession);
  if (set.T_base_camera) frontend.setNextPose(*set.T_base_camera);
  KeyframeCompressor compressor(options);
  TrackingRun run;
  for (std::size_t i = 0; i < set.frames.size(); ++i) {
    const bool has_wheels = use_wheels && i < set.wheels.size();
    const double start = threadTime();
    run.frames.push_back(frontend.track(
        *set.frames[i], has_wheels ? set.wheels[i] : std::optional<Eigen::Isometry3d>()));
    run.track_times.push_back(threadTime() - start);
    compressCompleted(frontend, compressor, run);
  }
  frontend.finish();
  compressCompleted(frontend, compressor, run);
  return run;
}

TrajectoryErrors odometryErrors(const FrameSet& set, const TrackingRun& run) {
  Trajectory estimate;
  for (const FrameResult& frame : run.frames) {
    if (frame.status == TrackingStatus::kLost) continue;
    estimate.push_back({frame.stamp, frame.T_odom_camera});
  }
  return evaluateTrajectories({{set.truth, std::move(estimate)}});
}

TrajectoryErrors systemErrors(const std::shared_ptr<const FrameSet>& set,
                              const FrontendOptions& options) {
  ReplayOptions replay;
  replay.robots.frontend = options;
  const ReplayResult result = runReplay({std::make_shared<MemoryRecording>(set)}, replay);
  return evaluateTrajectories(
      {{set->truth, extractTrajectories(result.robots.front(), *result.map).frames}});
}

}  // namespace planecloud::bench

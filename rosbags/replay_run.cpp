// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/rosbags/replay_run.h"

#include <algorithm>
#include <utility>

#include "planecloud_slam/rosbags/frame_stream.h"
#include "planecloud_slam/rosbags/keyframe_wire_size.h"
#include "planecloud_slam/rosbags/stopwatch.h"

namespace planecloud {
namespace {

constexpr std::size_t kFramesAhead = 4;  // raw images are large
constexpr std::size_t kStepsAhead = 64;  // steps are small

/// The steps of all robots in one order. With several threads the robots' frontends are dealt to
/// all but one of them, which is left to the backend; images are read by further ones if there are.
FrameStream makeStream(const std::vector<std::shared_ptr<Recording>>& recordings,
                       const ReplayOptions& options) {
  const auto threads = static_cast<std::size_t>(std::max(1, options.threads));
  const std::size_t groups = std::clamp<std::size_t>(threads - 1, 1, recordings.size());
  RobotReplayOptions robot_options = options.robots;
  if (threads > recordings.size() + 1) robot_options.read_ahead = kFramesAhead;
  std::vector<std::vector<FrameStream>> grouped(groups);
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    const auto robot = std::make_shared<RobotReplay>(recordings[i], i, robot_options);
    grouped[i % groups].push_back([robot] { return robot->next(); });
  }
  std::vector<FrameStream> streams;
  for (std::vector<FrameStream>& group : grouped) {
    FrameStream stream = mergeByStamp(std::move(group));
    streams.push_back(threads > 1 ? readAhead(std::move(stream), kStepsAhead) : std::move(stream));
  }
  return mergeByStamp(std::move(streams));
}

/// The backend fed with the steps, and the book kept of them.
class ReplayRun {
 public:
  ReplayRun(const std::vector<std::shared_ptr<Recording>>& recordings, const ReplayOptions& options)
      : options_(options), backend_(options.backend) {
    for (const auto& recording : recordings) {
      RobotLog log;
      log.robot = recording->robot();
      result_.robots.push_back(std::move(log));
    }
  }

  void take(ReplayedFrame step) {
    RobotLog& log = result_.robots[step.robot];
    if (!step.note.empty()) options_.on_note(step.note);
    for (ReplayedKeyframe& replayed : step.keyframes) {
      log.fit_times.push_back(replayed.fit_time);
      log.keyframe_bytes.push_back(static_cast<double>(keyframeWireSize(replayed.keyframe)));
      insert(std::move(replayed.keyframe));
    }
    if (!step.result) return;
    log.track_times.push_back(step.track_time);
    log.frames.push_back(std::move(*step.result));
    options_.on_frame();
  }

  ReplayResult finish() {
    const Stopwatch stopwatch;
    backend_.optimize();
    addOptimizeTime(stopwatch.elapsed());
    result_.map = backend_.snapshot();
    result_.statistics = backend_.statistics();
    return std::move(result_);
  }

 private:
  void insert(Keyframe keyframe) {
    const KeyframeId id = keyframe.id;
    const Stopwatch stopwatch;
    const InsertionResult inserted = backend_.insert(std::move(keyframe));
    if (backend_.optimisationDue()) backend_.optimize();
    const double elapsed = stopwatch.elapsed();
    if (inserted.optimised) {
      addOptimizeTime(elapsed);
    } else {
      result_.backend_time += elapsed;
    }
    if (inserted.status != InsertionStatus::kInserted) {
      options_.on_note("keyframe " + toString(id) + " is not in the map: " + inserted.reason);
    }
  }

  void addOptimizeTime(double elapsed) {
    result_.optimize_times.push_back(elapsed);
    result_.backend_time += elapsed;
  }

  const ReplayOptions& options_;
  Backend backend_;
  ReplayResult result_;
};

}  // namespace

ReplayResult runReplay(const std::vector<std::shared_ptr<Recording>>& recordings,
                       ReplayOptions options) {
  options.robots.frontend.plane_fit.time_budget = 0.0;
  ReplayRun run(recordings, options);
  const FrameStream stream = makeStream(recordings, options);
  while (std::optional<ReplayedFrame> step = stream()) run.take(std::move(*step));
  ReplayResult result = run.finish();
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    result.robots[i].ground_truth = recordings[i]->groundTruth();
  }
  return result;
}

}  // namespace planecloud

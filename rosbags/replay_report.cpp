// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/rosbags/replay_report.h"

#include <sys/resource.h>

#include <cstdio>
#include <numeric>
#include <utility>

#include "planecloud_slam/rosbags/sample_statistics.h"
#include "planecloud_slam/rosbags/trajectory_evaluation.h"

namespace planecloud {
namespace {

using Json = nlohmann::ordered_json;

/// Median and 95th percentile of times [s] in milliseconds.
Json milliseconds(const std::vector<double>& seconds) {
  const SampleStatistics statistics = summarise(seconds);
  return {{"median", 1e3 * statistics.median}, {"p95", 1e3 * statistics.p95}};
}

std::size_t countLost(const RobotLog& log) {
  std::size_t lost = 0;
  for (const FrameResult& frame : log.frames) {
    if (frame.status == TrackingStatus::kLost) ++lost;
  }
  return lost;
}

Json reportRobot(const RobotLog& log, const RobotTrajectories& trajectories) {
  const SampleStatistics bytes = summarise(log.keyframe_bytes);
  const std::size_t lost = countLost(log);
  return {{"frames", log.frames.size()},
          {"tracked", log.frames.size() - lost},
          {"lost", lost},
          {"keyframes", log.keyframe_bytes.size()},
          {"keyframe_bytes", {{"mean", bytes.mean}, {"total", bytes.total}}},
          {"track_ms", milliseconds(log.track_times)},
          {"fit_ms", milliseconds(log.fit_times)},
          {"path_m", trajectories.path_length}};
}

std::size_t countRejected(const BackendStatistics& statistics) {
  std::size_t rejected = 0;
  for (const auto& [reason, count] : statistics.rejected) rejected += count;
  return rejected;
}

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

/// Recorded time of all robots by the time one core needed for it.
double realtimeFactor(const ReplayResult& result) {
  double recorded = 0.0;
  double needed = result.backend_time;
  for (const RobotLog& log : result.robots) {
    if (!log.frames.empty()) recorded += log.frames.back().stamp - log.frames.front().stamp;
    needed += sum(log.track_times) + sum(log.fit_times);
  }
  return recorded / needed;
}

/// The most memory this process ever had [MB].
double peakMemory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) * 1024.0 / 1e6;  // Linux counts in KiB
}

std::vector<TrajectoryPair> pairUp(const ReplayResult& result,
                                   const std::vector<RobotTrajectories>& trajectories,
                                   Trajectory RobotTrajectories::*estimate) {
  std::vector<TrajectoryPair> pairs;
  for (std::size_t i = 0; i < trajectories.size(); ++i) {
    pairs.push_back({result.robots[i].ground_truth, trajectories[i].*estimate});
  }
  return pairs;
}

ReplayJudgement judge(const ReplayResult& result,
                      const std::vector<RobotTrajectories>& trajectories) {
  ReplayJudgement judgement;
  const auto frames = pairUp(result, trajectories, &RobotTrajectories::frames);
  judgement.ate_rmse = evaluateTrajectories(frames).ate_rmse;
  judgement.odometry_ate_rmse =
      separatelyAlignedError(pairUp(result, trajectories, &RobotTrajectories::odometry));
  std::vector<PosePair> poses;
  for (const TrajectoryPair& pair : frames) {
    const std::vector<PosePair> matched = matchPoses(pair);
    poses.insert(poses.end(), matched.begin(), matched.end());
  }
  judgement.T_world_map = alignPoses(poses);
  std::vector<RobotTruth> truths;
  for (const RobotLog& log : result.robots) truths.push_back({log.robot, log.ground_truth});
  judgement.closures = judgeClosures(*result.map, truths);
  return judgement;
}

template <typename... Values>
std::string format(const char* pattern, Values... values) {
  char text[256];
  std::snprintf(text, sizeof(text), pattern, values...);
  return text;
}

std::string summariseRobot(const RobotLog& log, const RobotTrajectories& trajectories) {
  const SampleStatistics bytes = summarise(log.keyframe_bytes);
  return format(
      "%-10s %zu frames, %zu lost; %.1f m; %zu keyframes of %.2f KB (%.1f KB/m); "
      "%.1f ms a frame\n",
      log.robot.c_str(), log.frames.size(), countLost(log), trajectories.path_length,
      log.keyframe_bytes.size(), 1e-3 * bytes.mean, 1e-3 * bytes.total / trajectories.path_length,
      1e3 * summarise(log.track_times).median);
}

}  // namespace

JudgedReplay judgeReplay(ReplayResult result) {
  JudgedReplay replay;
  bool has_truth = false;
  for (const RobotLog& log : result.robots) {
    replay.trajectories.push_back(extractTrajectories(log, *result.map));
    has_truth = has_truth || !log.ground_truth.empty();
  }
  if (has_truth) replay.judgement = judge(result, replay.trajectories);
  replay.result = std::move(result);
  return replay;
}

nlohmann::ordered_json makeReport(const JudgedReplay& replay) {
  const ReplayResult& result = replay.result;
  Json robots = Json::object();
  for (std::size_t i = 0; i < result.robots.size(); ++i) {
    robots[result.robots[i].robot] = reportRobot(result.robots[i], replay.trajectories[i]);
  }
  Json report = {{"robots", robots},
                 {"loop_closures",
                  {{"intra", result.statistics.closures_intra},
                   {"inter", result.statistics.closures_inter},
                   {"rejected", countRejected(result.statistics)}}},
                 {"coplanar_edges", result.statistics.coplanar_edges},
                 {"components", result.map->components},
                 {"optimize_ms", milliseconds(result.optimize_times)},
                 {"realtime_factor", realtimeFactor(result)},
                 {"peak_rss_mb", peakMemory()}};
  if (replay.judgement) {
    report["ground_truth"] = {{"ate_rmse_m", replay.judgement->ate_rmse},
                              {"odometry_ate_rmse_m", replay.judgement->odometry_ate_rmse},
                              {"closures_false", replay.judgement->closures.false_closures},
                              {"closures_possible", replay.judgement->closures.possible},
                              {"closures_found", replay.judgement->closures.found}};
  }
  return report;
}

std::string summarise(const JudgedReplay& replay) {
  const ReplayResult& result = replay.result;
  std::string text;
  for (std::size_t i = 0; i < result.robots.size(); ++i) {
    text += summariseRobot(result.robots[i], replay.trajectories[i]);
  }
  text += format(
      "map        %zu keyframes in %d component%s; loop closures: %zu within a robot, "
      "%zu between robots, %zu rejected\n",
      result.map->nodes.size(), result.map->components, result.map->components == 1 ? "" : "s",
      result.statistics.closures_intra, result.statistics.closures_inter,
      countRejected(result.statistics));
  if (replay.judgement) {
    text += format(
        "truth      ATE %.4f m (odometry alone %.4f m); %zu closures false, %zu of %zu "
        "keyframes closed that could be\n",
        replay.judgement->ate_rmse, replay.judgement->odometry_ate_rmse,
        replay.judgement->closures.false_closures, replay.judgement->closures.found,
        replay.judgement->closures.possible);
  }
  text += format("speed      %.1f times real time on one core, %.0f MB\n", realtimeFactor(result),
                 peakMemory());
  return text;
}

}  // namespace planecloud

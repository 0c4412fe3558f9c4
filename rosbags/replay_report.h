// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "planecloud_slam/rosbags/closure_judge.h"
#include "planecloud_slam/rosbags/replay_run.h"
#include "planecloud_slam/rosbags/replay_trajectories.h"

namespace planecloud {

/// What ground truth says of a replay.
struct ReplayJudgement {
  /// Of all robots' frames under one alignment [m].
  double ate_rmse = 0.0;
  /// Of all robots' odometry, each aligned on its own: their frames are unrelated [m].
  double odometry_ate_rmse = 0.0;
  Eigen::Isometry3d T_world_map = Eigen::Isometry3d::Identity();  ///< the alignment
  ClosureJudgement closures;
};

/// A replay and all that is derived from it.
struct JudgedReplay {
  ReplayResult result;
  std::vector<RobotTrajectories> trajectories;  ///< as `result.robots`
  std::optional<ReplayJudgement> judgement;     ///< none: no robot has ground truth
};

[[nodiscard]] JudgedReplay judgeReplay(ReplayResult result);

/// report.json: SI units unless a key says otherwise; what is undefined is null.
[[nodiscard]] nlohmann::ordered_json makeReport(const JudgedReplay& replay);

/// The figures a person wants, a few lines.
[[nodiscard]] std::string summarise(const JudgedReplay& replay);

}  // namespace planecloud

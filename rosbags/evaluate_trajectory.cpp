// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>

#include "planecloud_slam/rosbags/command_line.h"
#include "planecloud_slam/rosbags/trajectory_evaluation.h"
#include "planecloud_slam/rosbags/trajectory_file.h"
#include "planecloud_slam/rosbags/usage_error.h"

namespace planecloud {
namespace {

namespace po = boost::program_options;

// Three points make an alignment unique.
constexpr std::size_t kFewestPairs = 3;
constexpr double kDegrees = 180.0 / M_PI;

ToolDescription describe() {
  ToolDescription tool;
  tool.name = "evaluate_trajectory";
  tool.summary =
      "Judges estimated trajectories by their ground truth: absolute trajectory error (ATE) after\n"
      "alignment without scale, relative pose error (RPE) over 1 s, drift at the end.";
  tool.synopsis = "GROUNDTRUTH ESTIMATE [GROUNDTRUTH ESTIMATE ...] [--json]";
  tool.notes =
      "Files are in the TUM format, 'stamp tx ty tz qx qy qz qw' a line. Several pairs share one\n"
      "alignment, so robots must agree. Ground truth is interpolated at the estimate's stamps;\n"
      "poses in gaps of it over 50 ms are skipped. The end drift is the distance to the truth at\n"
      "the end, the first second aligned, in percent of the path.";
  tool.flags.add_options()("json", po::bool_switch(), "print the figures as JSON");
  tool.arguments = {"FILES"};
  return tool;
}

TrajectoryPair readPair(const std::string& truth, const std::string& estimate) {
  TrajectoryPair pair{readTrajectory(truth), readTrajectory(estimate)};
  if (pair.truth.empty()) throw std::runtime_error("no pose in '" + truth + "'");
  if (pair.estimate.empty()) throw std::runtime_error("no pose in '" + estimate + "'");
  if (matchPoses(pair).size() < kFewestPairs) {
    throw std::runtime_error("fewer than 3 poses of '" + estimate + "' have ground truth in '" +
                             truth + "': the stamps of both must come from one clock");
  }
  return pair;
}

void printTable(const TrajectoryErrors& errors) {
  std::printf("matched poses        %10zu\n", errors.pairs);
  std::printf("ATE RMSE             %10.4f m\n", errors.ate_rmse);
  std::printf("RPE over 1 s, RMSE   %10.4f m  %8.3f deg\n", errors.rpe_trans_rmse,
              errors.rpe_rot_rmse * kDegrees);
  std::printf("drift at the end     %10.2f %%\n", 100.0 * errors.end_drift);
}

void printJson(const TrajectoryErrors& errors) {
  const nlohmann::ordered_json json = {{"pairs", errors.pairs},
                                       {"ate_rmse_m", errors.ate_rmse},
                                       {"rpe_trans_rmse_m", errors.rpe_trans_rmse},
                                       {"rpe_rot_rmse_deg", errors.rpe_rot_rmse * kDegrees},
                                       {"end_drift_percent", 100.0 * errors.end_drift}};
  std::cout << json.dump(2) << '\n';
}

int evaluate(const ParsedFlags& flags) {
  const auto files = flags["FILES"].as<std::vector<std::string>>();
  if (files.size() % 2 != 0) {
    throw UsageError("an odd number of files: each GROUNDTRUTH needs its ESTIMATE");
  }
  std::vector<TrajectoryPair> pairs;
  for (std::size_t i = 0; i < files.size(); i += 2) {
    pairs.push_back(readPair(files[i], files[i + 1]));
  }
  const TrajectoryErrors errors = evaluateTrajectories(pairs);
  if (flags["json"].as<bool>()) {
    printJson(errors);
  } else {
    printTable(errors);
  }
  return 0;
}

}  // namespace
}  // namespace planecloud

int main(int argc, char** argv) {
  return planecloud::runTool(planecloud::describe(), argc, argv, planecloud::evaluate);
}

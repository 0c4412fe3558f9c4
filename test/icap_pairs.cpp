// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "icap_pairs.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <optional>
#include <random>
#include <sstream>
#include <stdexcept>

#include "planecloud_slam/plane_fit/se3.h"
#include "planecloud_slam/rosbags/trajectory_evaluation.h"

namespace planecloud {
namespace {

constexpr unsigned kSeed = 7;
constexpr double kNearest = 0.05;                             // [m]
constexpr double kFarthest = 0.4;                             // [m]
constexpr double kWidestTurn = 3.14159265358979323846 / 6.0;  // [rad]

}  // namespace

std::vector<StampPair> choosePairs(const SequenceFolder& folder, std::size_t count) {
  std::vector<StampPair> pairs;
  for (auto target = folder.pairs.begin(); target != folder.pairs.end(); ++target) {
    const auto T_world_target = poseAt(folder.ground_truth, target->depth_stamp);
    if (!T_world_target) continue;
    for (auto source = target + 1; source != folder.pairs.end(); ++source) {
      const auto T_world_source = poseAt(folder.ground_truth, source->depth_stamp);
      if (!T_world_source) continue;
      const Eigen::Isometry3d T = T_world_target->inverse() * *T_world_source;
      const double distance = T.translation().norm();
      if (distance < kNearest || distance > kFarthest || rotationAngle(T) >= kWidestTurn) continue;
      pairs.push_back({target->depth_stamp, source->depth_stamp});
    }
  }
  if (pairs.size() > count) {
    std::mt19937 random(kSeed);
    std::shuffle(pairs.begin(), pairs.end(), random);
    pairs.resize(count);
  }
  return pairs;
}

std::vector<StampPair> readPairs(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error(path + ": cannot be read");
  std::vector<StampPair> pairs;
  std::string line;
  while (std::getline(file, line)) {
    if (line.empty() || line[0] == '#') continue;
    StampPair pair;
    if (!(std::istringstream(line) >> pair.target >> pair.source)) {
      throw std::runtime_error(path + ": not a pair of stamps: " + line);
    }
    pairs.push_back(pair);
  }
  return pairs;
}

void printPairs(const std::vector<StampPair>& pairs) {
  for (const StampPair& pair : pairs) std::printf("%.6f %.6f\n", pair.target, pair.source);
}

}  // namespace planecloud

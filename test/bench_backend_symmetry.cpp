// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
//
// False closures in worlds that repeat themselves: a hall around a block whose furniture comes back
// after half a turn (a cabinet looks alike from both sides), one with the same alcove every two
// metres (doors of an office), known odometry; and the first one with a single box that tells one
// side from the other, seen by two robots of unknown relation, the second one after the first.
// Ten seeds of noise and furniture each; false and found as in the report of `replay`.
// Usage: bench_backend_symmetry [SEEDS] [key=value...], e.g. loop_closure/consistency/min_inter=3
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "painted_world.h"
#include "planecloud_slam/backend_node/backend.h"
#include "planecloud_slam/plane_fit/option_values.h"
#include "planecloud_slam/rosbags/closure_judge.h"

namespace planecloud {
namespace {

constexpr double kSpacing = 0.3;  ///< of keyframes [m]
constexpr double kPeriod = 2.0;   ///< of the alcoves [m]

/// The hall of `hallPose`, bare.
PaintedWorld bareHall() {
  PaintedWorld world;
  world.addBox({0.0, 0.0, 1.3}, {5.5, 4.0, 1.3}, 1);
  world.addBox({0.0, 0.0, 1.3}, {2.9, 1.5, 1.3}, 2);
  return world;
}

/// Boxes along the outer walls of a hall, each of them again after half a turn about its middle.
PaintedWorld halfTurnHall(unsigned seed) {
  PaintedWorld world = bareHall();
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform;
  const auto between = [&](double low, double high) {
    return low + (high - low) * uniform(random);
  };
  const auto addTwice = [&](const Eigen::Vector2d& place, const Eigen::Vector3d& half) {
    const auto paint = static_cast<std::uint32_t>(random());
    world.addBox({place.x(), place.y(), half.z()}, half, paint);
    world.addBox({-place.x(), -place.y(), half.z()}, half, paint);
  };
  for (double x = -5.0; x < 4.5; x += between(0.8, 2.2)) {
    const Eigen::Vector3d half(between(0.15, 0.5), between(0.1, 0.3), between(0.2, 1.1));
    addTwice({x + half.x(), -4.0 + half.y()}, half);
  }
  for (double y = -3.0; y < 2.5; y += between(0.8, 2.2)) {
    const Eigen::Vector3d half(between(0.1, 0.3), between(0.15, 0.5), between(0.2, 1.1));
    addTwice({5.5 - half.x(), y + half.y()}, half);
  }
  return world;
}

/// The same box every `kPeriod` along all outer walls.
PaintedWorld periodicHall(unsigned seed) {
  PaintedWorld world = bareHall();
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> size(0.15, 0.45);
  const Eigen::Vector3d half(size(random), 0.5 * size(random), 2.0 * size(random));
  for (double way = -4.0; way <= 4.0; way += kPeriod) {
    for (const double side : {-1.0, 1.0}) {
      world.addBox({way, side * (4.0 - half.y()), half.z()}, half, 3);
      if (std::abs(way) > 2.5) continue;
      world.addBox({side * (5.5 - half.y()), way, half.z()}, {half.y(), half.x(), half.z()}, 3);
    }
  }
  return world;
}

struct Settings {
  unsigned seeds = 10;
  BackendOptions backend;
};

struct Outcome {
  std::size_t closures = 0;
  std::size_t false_closures = 0;
  std::size_t possible = 0;
  std::size_t found = 0;
  int components = 0;
};

/// Two rounds of every robot, one after the other; the second begins half a round further on.
Outcome drive(const PaintedWorld& world, int robots, unsigned seed, const BackendOptions& options) {
  Backend backend(options);
  std::vector<RobotTruth> truths;
  for (int i = 0; i < robots; ++i) {
    PaintedRobot robot(world, "robot" + std::to_string(i + 1),
                       10 * seed + static_cast<unsigned>(i));
    RobotTruth truth{"robot" + std::to_string(i + 1), {}};
    const double start = 0.5 * kHallRound * i;
    for (double way = 0.0; way < 2.0 * kHallRound; way += kSpacing) {
      Keyframe keyframe = robot.see(hallPose(start + way));
      truth.trajectory.push_back({keyframe.stamp, robot.truth.back()});
      backend.insert(std::move(keyframe));
    }
    truths.push_back(std::move(truth));
  }
  backend.optimize();
  const auto map = backend.snapshot();
  const ClosureJudgement judgement = judgeClosures(*map, truths);
  return {judgement.closures.size(), judgement.false_closures, judgement.possible, judgement.found,
          map->components};
}

void report(const char* name, const std::vector<Outcome>& outcomes) {
  Outcome sum;
  std::size_t worst = 0;
  double least = 1.0;
  for (const Outcome& outcome : outcomes) {
    sum.closures += outcome.closures;
    sum.false_closures += outcome.false_closures;
    sum.possible += outcome.possible;
    sum.found += outcome.found;
    sum.components += outcome.components;
    worst = std::max(worst, outcome.false_closures);
    const auto possible = static_cast<double>(std::max<std::size_t>(1, outcome.possible));
    least = std::min(least, static_cast<double>(outcome.found) / possible);
  }
  const auto possible = static_cast<double>(std::max<std::size_t>(1, sum.possible));
  std::printf(
      "%-34s %5zu closures, %3zu false (worst seed %zu); found %5.1f %% of %zu possible, "
      "worst seed %5.1f %%; %.1f components\n",
      name, sum.closures, sum.false_closures, worst,
      100.0 * static_cast<double>(sum.found) / possible, sum.possible, 100.0 * least,
      static_cast<double>(sum.components) / static_cast<double>(outcomes.size()));
}

/// Drives through the worlds of all seeds.
void runWorld(const char* name, const std::function<PaintedWorld(unsigned)>& make_world, int robots,
              const Settings& settings) {
  std::vector<Outcome> outcomes;
  for (unsigned seed = 1; seed <= settings.seeds; ++seed) {
    outcomes.push_back(drive(make_world(seed), robots, seed, settings.backend));
  }
  report(name, outcomes);
}

int run(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  Settings settings;
  OptionValues values;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const std::size_t equals = argument.find('=');
    if (equals == std::string::npos) {
      settings.seeds = static_cast<unsigned>(std::atoi(argv[i]));
    } else {
      values[argument.substr(0, equals)] = argument.substr(equals + 1);
    }
  }
  takeOptions(values, settings.backend, "");
  if (!values.empty() || settings.seeds == 0) return 2;
  runWorld("the same after half a turn", halfTurnHall, 1, settings);
  runWorld("the same every two metres", periodicHall, 1, settings);
  const auto marked_hall = [](unsigned seed) {
    PaintedWorld world = halfTurnHall(seed);
    world.addBox({-0.6, -1.7, 0.8}, {0.35, 0.2, 0.8}, 99);
    return world;
  };
  runWorld("half a turn but one box, two robots", marked_hall, 2, settings);
  return 0;
}

}  // namespace
}  // namespace planecloud

int main(int argc, char** argv) { return planecloud::run(argc, argv); }

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What a map costs as it grows: robots of unknown start wander through a city block of corridors
// and send keyframes in turn. Insertion is the time until a keyframe's pose is optimised locally
// and a snapshot of the map is there for publishers, as in the node; the optimisations of the whole
// graph, which run on a thread of their own there, are counted apart. Times are CPU times of one
// thread. Resident growth is counted from the empty backend, less the keyframes as they travelled
// (planes and descriptor), after freed memory went back to the system.
//
// Usage: bench_backend [KEYFRAMES [ROBOTS]] [key=value...], e.g. 10000 20 graph/local_window=200
#include <malloc.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "city_block.h"
#include "map_truth.h"
#include "planecloud_slam/backend_node/backend.h"
#include "planecloud_slam/plane_fit/option_values.h"
#include "planecloud_slam/rosbags/sample_statistics.h"
#include "thread_time.h"

namespace planecloud {
namespace {

constexpr unsigned kSeed = 1;
constexpr int kRows = 10;          ///< of the table
constexpr double kSpacing = 0.25;  ///< of keyframes [m]

struct Settings {
  int keyframes = 2000;
  int robots = 20;
  BackendOptions backend;
};

/// Memory of this process that is in use [MB].
double residentMegabytes() {
  malloc_trim(0);
  std::ifstream file("/proc/self/statm");
  double total = 0.0;
  double resident = 0.0;
  file >> total >> resident;
  return 4096e-6 * resident;
}

/// Feeds a backend as the node does and keeps the book.
class Trial {
 public:
  explicit Trial(const Settings& settings)
      : settings_(settings), city_(makeCityBlock(kSeed)), backend_(settings.backend) {
    for (int i = 0; i < settings.robots; ++i) {
      const unsigned seed = kSeed + 100U * (static_cast<unsigned>(i) + 1U);
      robots_.emplace_back(city_, "robot" + std::to_string(i + 1), seed);
      walks_.emplace_back(seed);
    }
    empty_ = residentMegabytes();
  }

  void run() {
    std::printf("%9s %26s %17s %6s %9s %9s %6s %11s %11s\n", "keyframes",
                "insertion ms, med p95 max", "whole s, sum max", "maps", "tried", "closures",
                "false", "compressed", "resident");
    const int row = std::max(1, settings_.keyframes / kRows);
    for (int i = 0; i < settings_.keyframes; ++i) {
      const auto robot = static_cast<std::size_t>(i % settings_.robots);
      insert(robots_[robot].see(walks_[robot].advance(kSpacing)));
      if ((i + 1) % row == 0) print(i + 1);
    }
  }

 private:
  void insert(Keyframe keyframe) {
    bytes_ += static_cast<double>(keyframe.planes.bytes.size() + keyframe.descriptor.size());
    const double start = threadTime();
    const InsertionResult result = backend_.insert(std::move(keyframe));
    snapshot_ = backend_.snapshot();
    double time = threadTime() - start;
    for (const GraphEdge& closure : result.closures) denounce(closure);
    if (backend_.optimisationDue()) time += optimiseWhole();
    insertions_.push_back(1e3 * time);
  }

  /// Names a closure on stderr when it is false, whether it will be found false later or not.
  void denounce(const GraphEdge& closure) const {
    Truth truth;
    for (const KeyframeId& id : {closure.from, closure.to}) truth.emplace(id, truePose(id));
    if (!isFalse(closure, truth)) return;
    const Vector6d error = closureError(closure, truth);
    std::fprintf(stderr, "false closure: %s to %s, off by %.2f m and %.1f degrees\n",
                 toString(closure.from).c_str(), toString(closure.to).c_str(),
                 error.head<3>().norm(), error.tail<3>().norm() * 180.0 / M_PI);
  }

  [[nodiscard]] const Eigen::Isometry3d& truePose(const KeyframeId& id) const {
    return robots_[static_cast<std::size_t>(std::stoi(id.robot.substr(5)) - 1)].truth[id.number];
  }

  /// Returns what of it the owner of the map has to do itself [s].
  double optimiseWhole() {
    const double start = threadTime();
    GraphOptimisation optimisation = backend_.startOptimisation();
    const double begin = threadTime();
    optimisation.run();
    const double end = threadTime();
    whole_.push_back(end - begin);
    backend_.finishOptimisation(optimisation);
    snapshot_ = backend_.snapshot();
    return begin - start + threadTime() - end;
  }

  void print(int keyframes) {
    const SampleStatistics insertion = summarise(insertions_);
    const SampleStatistics whole = whole_.empty() ? SampleStatistics() : summarise(whole_);
    const BackendStatistics statistics = backend_.statistics();
    std::size_t closures = statistics.closures_intra + statistics.closures_inter;
    std::size_t tried = closures;
    for (const auto& [reason, count] : statistics.rejected) tried += count;
    const double resident = residentMegabytes() - empty_ - 1e-6 * bytes_;
    std::printf("%9d %8.1f %8.1f %8.1f %9.1f %7.2f %6d %9zu %9zu %6d %8.1f MB %8.1f MB\n",
                keyframes, insertion.median, insertion.p95, insertion.max, whole.total, whole.max,
                statistics.components, tried, closures, falseClosures(*snapshot_, truth()),
                1e-6 * bytes_, resident);
    insertions_.clear();
    whole_.clear();
  }

  [[nodiscard]] Truth truth() const {
    Truth truth;
    for (const MapSnapshot::Node& node : snapshot_->nodes) {
      truth.emplace(node.keyframe->id, truePose(node.keyframe->id));
    }
    return truth;
  }

  Settings settings_;
  PaintedWorld city_;
  std::vector<PaintedRobot> robots_;
  std::vector<CityWalk> walks_;     ///< of the robots
  double empty_ = 0.0;              ///< resident before the first keyframe [MB]
  double bytes_ = 0.0;              ///< of the keyframes
  std::vector<double> insertions_;  ///< since the last row [ms]
  std::vector<double> whole_;       ///< likewise [s]
  Backend backend_;
  std::shared_ptr<const MapSnapshot> snapshot_;
};

bool readArguments(int argc, char** argv, Settings& settings) {
  OptionValues values;
  std::vector<int> numbers;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const std::size_t equals = argument.find('=');
    if (equals == std::string::npos) {
      numbers.push_back(std::atoi(argv[i]));
    } else {
      values[argument.substr(0, equals)] = argument.substr(equals + 1);
    }
  }
  if (!numbers.empty()) settings.keyframes = numbers[0];
  if (numbers.size() > 1) settings.robots = numbers[1];
  takeOptions(values, settings.backend, "");
  return values.empty() && numbers.size() <= 2 && settings.keyframes > 0 && settings.robots > 0;
}

int run(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  Settings settings;
  if (!readArguments(argc, argv, settings)) {
    std::fprintf(stderr, "usage: bench_backend [KEYFRAMES [ROBOTS]] [key=value...]\n");
    return 2;
  }
  Trial(settings).run();
  return 0;
}

}  // namespace
}  // namespace planecloud

int main(int argc, char** argv) { return planecloud::run(argc, argv); }

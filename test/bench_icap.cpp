// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How often, how well and how fast ICaP aligns pairs of real keyframes as they travel (default
// frontend: rectified, fitted, encoded, decoded), against PCL's ICP and GICP on the dense clouds of
// the same pairs, and what it makes of corridors. Success: within 5 cm and 2.5 degrees of the
// ground truth. That has errors of its own (freiburg1: its clock): `from truth` says what comes of
// starting there, `same` how many guesses come to that answer within 2 cm and 1 degree. CPU times.
//
// Usage: bench_icap TUM_FOLDER:PAIRS_FILE... [--peers N] [--guesses N] [key=value...]
//   --peers N    also align every N-th pair by PCL, first guess only (0: none)
//   key=value    e.g. icap/fine_tile=16, plane_fit/tolerance=0.004
//        bench_icap --list TUM_FOLDER COUNT     prints a PAIRS_FILE
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "icap_corridor.h"
#include "icap_pairs.h"
#include "icap_peers.h"
#include "planecloud_slam/frontend_node/frontend_options.h"
#include "planecloud_slam/frontend_node/keyframe_compressor.h"
#include "planecloud_slam/frontend_node/rectifier.h"
#include "planecloud_slam/icap/icap.h"
#include "planecloud_slam/plane_fit/option_values.h"
#include "planecloud_slam/rosbags/sample_statistics.h"
#include "planecloud_slam/rosbags/trajectory_evaluation.h"
#include "thread_time.h"

namespace planecloud {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180.0;
constexpr unsigned kCorridorSeeds = 100;

/// How far off the guesses are.
struct Offset {
  const char* name;
  double distance;  // [m]
  double angle;     // [rad]
};
constexpr Offset kOffsets[] = {{"10 cm, 5 deg", 0.1, 5.0 * kDegree},
                               {"30 cm, 15 deg", 0.3, 15.0 * kDegree}};

struct Settings {
  std::vector<std::pair<std::string, std::string>> sequences;  // folder, pairs
  int peers = 0;
  int guesses = 5;
  FrontendOptions frontend;
  IcapOptions icap;
};

struct View {
  PlaneSet planes;
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  Image<float> depth;
  CameraIntrinsics camera;
  std::size_t tiles = 0;
  double preparation = 0.0;  // of the plane set [s]
};

/// What one method did with all guesses of one kind.
struct Score {
  int good = 0;
  int same = 0;
  int degenerate = 0;
  std::vector<double> distances, angles, times, normalised;

  void add(const Eigen::Isometry3d& T_true, const Eigen::Isometry3d& T, double time) {
    const Eigen::Isometry3d error = T_true.inverse() * T;
    distances.push_back(error.translation().norm());
    angles.push_back(rotationAngle(error));
    times.push_back(time);
    if (distances.back() <= 0.05 && angles.back() <= 2.5 * kDegree) ++good;
  }
  /// Median over those that succeeded.
  [[nodiscard]] double goodMedian(const std::vector<double>& values) const {
    std::vector<double> chosen;
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (distances[i] <= 0.05 && angles[i] <= 2.5 * kDegree) chosen.push_back(values[i]);
    }
    return summarise(chosen).median;
  }
};

View makeView(const SequenceFolder& folder, const SequencePair& pair, const Settings& settings) {
  SequenceImages images = readSequenceImages(folder, pair);
  RgbdFrame frame;
  frame.stamp = pair.depth_stamp;
  frame.grey = greyFromColor(images.color);
  frame.depth = std::move(images.depth);
  View view;
  view.camera = folder.camera;
  if (folder.camera.hasDistortion() && settings.frontend.undistort) {
    const Rectifier rectifier(folder.camera);
    frame = rectifier.rectify(frame);
    view.camera = rectifier.camera();
  }
  view.depth = frame.depth;
  KeyframeCompressor compressor(settings.frontend);
  const Keyframe keyframe =
      compressor.compress({Keyframe(), std::move(frame.depth), std::move(frame.grey), view.camera});
  const PlaneCloud cloud = decode(keyframe.planes);
  view.tiles = cloud.tiles.size();
  const double start = threadTime();
  view.planes = PlaneSet(cloud, settings.icap.planes);
  view.preparation = threadTime() - start;
  view.T_world_camera = poseAt(folder.ground_truth, pair.depth_stamp).value();
  return view;
}

using Views = std::map<double, View>;  // by stamp

Views loadViews(const SequenceFolder& folder, const std::vector<StampPair>& pairs,
                const Settings& settings) {
  Views views;
  const auto wanted = [&](double stamp) {
    return std::any_of(pairs.begin(), pairs.end(), [&](const StampPair& pair) {
      return pair.target == stamp || pair.source == stamp;
    });
  };
  for (const SequencePair& pair : folder.pairs) {
    if (wanted(pair.depth_stamp)) {
      views.emplace(pair.depth_stamp, makeView(folder, pair, settings));
    }
  }
  return views;
}

/// Returns what ICaP found.
Eigen::Isometry3d scoreIcap(const View& target, const View& source, const Eigen::Isometry3d& guess,
                            const IcapOptions& options, Score& score) {
  const Eigen::Isometry3d T_true = target.T_world_camera.inverse() * source.T_world_camera;
  const double start = threadTime();
  const IcapResult result = icap(target.planes, source.planes, guess, options);
  score.add(T_true, result.T_target_source, threadTime() - start);
  if (result.status == IcapStatus::kDegenerate) ++score.degenerate;
  const bool good = score.distances.back() <= 0.05 && score.angles.back() <= 2.5 * kDegree;
  if (!good || result.unobserved.size() > 5) return result.T_target_source;
  const Vector6d error = logSe3(result.T_target_source.inverse() * T_true);
  score.normalised.push_back(error.dot(result.information * error) /
                             static_cast<double>(6 - result.unobserved.size()));
  return result.T_target_source;
}

bool sameAnswer(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  const Eigen::Isometry3d apart = a.inverse() * b;
  return apart.translation().norm() <= 0.02 && rotationAngle(apart) <= kDegree;
}

void scorePeers(const View& target, const View& source, const Eigen::Isometry3d& guess,
                std::map<std::string, Score>& scores) {
  const Eigen::Isometry3d T_true = target.T_world_camera.inverse() * source.T_world_camera;
  const DenseView dense_target(target.depth, target.camera);
  const DenseView dense_source(source.depth, source.camera);
  double start = threadTime();
  Eigen::Isometry3d T = alignPointToPlane(dense_target, dense_source, guess);
  scores["PCL point-to-plane"].add(T_true, T, threadTime() - start);
  scores["  its normals"].add(T_true, T, dense_target.normalsTime() + dense_source.normalsTime());
  start = threadTime();
  T = alignGeneralised(dense_target, dense_source, guess);
  scores["PCL GICP"].add(T_true, T, threadTime() - start);
  scores["  its covariances"].add(T_true, T,
                                  dense_target.covariancesTime() + dense_source.covariancesTime());
}

void print(const std::string& name, const Score& score, double reference_time) {
  const SampleStatistics time = summarise(score.times);
  std::printf("  %-20s %4d/%-4zu %5.1f%% %7.1f %6.2f %8.3f %8.3f %8.1fx", name.c_str(), score.good,
              score.times.size(),
              100.0 * score.good / std::max<double>(1.0, static_cast<double>(score.times.size())),
              1e3 * score.goodMedian(score.distances), score.goodMedian(score.angles) / kDegree,
              1e3 * time.median, 1e3 * time.p95, time.median / reference_time);
  if (!score.normalised.empty()) {
    const SampleStatistics normalised = summarise(score.normalised);
    std::printf("   NEES/dof mean %.2f median %.2f   degenerate %d", normalised.mean,
                normalised.median, score.degenerate);
  }
  if (score.same > 0) std::printf("   same %d", score.same);
  std::printf("\n");
}

void runPairs(const Settings& settings, const std::vector<StampPair>& pairs, const Views& views) {
  for (const Offset& offset : kOffsets) {
    std::mt19937 random(11);
    Score robust, from_truth, paper;
    std::map<std::string, Score> peers;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const View& target = views.at(pairs[i].target);
      const View& source = views.at(pairs[i].source);
      const Eigen::Isometry3d T_true = target.T_world_camera.inverse() * source.T_world_camera;
      const Eigen::Isometry3d reached =
          scoreIcap(target, source, T_true, settings.icap, from_truth);
      for (int k = 0; k < settings.guesses; ++k) {
        const Eigen::Isometry3d guess =
            T_true * randomMotion(offset.distance, offset.angle, random);
        IcapOptions options = settings.icap;
        const Eigen::Isometry3d found = scoreIcap(target, source, guess, options, robust);
        if (sameAnswer(reached, found)) ++robust.same;
        options.form = IcapForm::kPaper;
        if (k == 0) (void)scoreIcap(target, source, guess, options, paper);
        const bool peer = settings.peers > 0 && i % static_cast<std::size_t>(settings.peers) == 0;
        if (peer && k == 0) scorePeers(target, source, guess, peers);
      }
    }
    std::printf(" guess off by %-13s %-11s %5s %7s %6s %8s %8s\n", offset.name, "success", "", "mm",
                "deg", "ms med.", "ms p95");
    const double reference = summarise(robust.times).median;
    print("ICaP", robust, reference);
    print("  from truth", from_truth, reference);
    print("ICaP as printed", paper, reference);
    for (const auto& [name, score] : peers) print(name, score, reference);
  }
}

void runSequence(const Settings& settings, const std::string& path, const std::string& list) {
  const SequenceFolder folder = openSequenceFolder(path, {});
  const std::vector<StampPair> pairs = readPairs(list);
  const Views views = loadViews(folder, pairs, settings);
  std::vector<double> tiles, preparation;
  for (const auto& [stamp, view] : views) {
    tiles.push_back(static_cast<double>(view.tiles));
    preparation.push_back(1e3 * view.preparation);
  }
  std::printf("%s: %zu pairs, %.0f tiles a side, prepared in %.2f ms a side\n",
              path.substr(path.find_last_of('/') + 1).c_str(), pairs.size(), summarise(tiles).mean,
              summarise(preparation).median);
  runPairs(settings, pairs, views);
}

void runCorridor(const IcapOptions& options) {
  for (const bool end_wall : {false, true}) {
    int degenerate = 0;
    double along = 0.0, across = 0.0, beside = 0.0;
    std::vector<double> normalised;
    for (unsigned seed = 0; seed < kCorridorSeeds; ++seed) {
      const CorridorTrial trial = alignInCorridor(end_wall, seed, options);
      degenerate += trial.result.status == IcapStatus::kDegenerate ? 1 : 0;
      along = std::max(along, std::abs(trial.along));
      across = std::max(across, trial.across);
      beside = std::max(beside, std::abs(trial.beside));
    }
    std::printf("corridor, %s: degenerate %d/%u, worst across %.1f mm, ",
                end_wall ? "with end wall" : "no end wall", degenerate, kCorridorSeeds,
                1e3 * across);
    if (end_wall) {
      std::printf("along %.1f mm from the truth\n", 1e3 * beside);
    } else {
      std::printf("along %.1f mm from the guess\n", 1e3 * along);
    }
  }
}

bool readArguments(int argc, char** argv, Settings& settings) {
  OptionValues values;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const std::size_t equals = argument.find('=');
    const std::size_t colon = argument.rfind(':');
    if ((argument == "--peers" || argument == "--guesses") && i + 1 < argc) {
      (argument == "--peers" ? settings.peers : settings.guesses) = std::atoi(argv[++i]);
    } else if (equals != std::string::npos) {
      values[argument.substr(0, equals)] = argument.substr(equals + 1);
    } else if (colon != std::string::npos) {
      settings.sequences.emplace_back(argument.substr(0, colon), argument.substr(colon + 1));
    } else {
      std::fprintf(stderr, "not understood: %s\n", argument.c_str());
      return false;
    }
  }
  takeOptions(values, settings.icap, "icap/");
  takeOptions(values, settings.frontend, "");
  if (!values.empty()) std::fprintf(stderr, "unknown key: %s\n", values.begin()->first.c_str());
  return values.empty();
}

int runAll(int argc, char** argv) {
  if (argc == 4 && std::string(argv[1]) == "--list") {
    printPairs(
        choosePairs(openSequenceFolder(argv[2], {}), static_cast<std::size_t>(std::atoi(argv[3]))));
    return 0;
  }
  Settings settings;
  if (!readArguments(argc, argv, settings)) return 2;
  for (const auto& [folder, list] : settings.sequences) runSequence(settings, folder, list);
  runCorridor(settings.icap);
  return 0;
}

}  // namespace
}  // namespace planecloud

int main(int argc, char** argv) { return planecloud::runAll(argc, argv); }

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How often, how well and how fast ICaP aligns pairs of real keyframes: for each sequence given,
// pairs 5-40 cm and less than 30 degrees apart, guesses off by 10 cm and 5 degrees in random
// directions; success is an end within 5 cm and 2.5 degrees of the ground truth.
// Usage: bench_icap TUM_FOLDER... [key=value...], e.g. icap/fine_tile=16 or plane_fit/lambda=0
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "planecloud_slam/icap/icap.h"
#include "planecloud_slam/icap/visibility.h"
#include "planecloud_slam/plane_fit/option_values.h"
#include "planecloud_slam/plane_fit/plane_cloud_codec.h"
#include "planecloud_slam/plane_fit/quadtree_fitter.h"
#include "planecloud_slam/rosbags/sequence_folder.h"
#include "planecloud_slam/rosbags/trajectory_evaluation.h"
#include "synthetic_planes.h"

namespace planecloud {
namespace {

constexpr int kPairs = 60;
constexpr double kDegree = 3.14159265358979323846 / 180.0;

struct View {
  PlaneSet planes;
  Eigen::Isometry3d T_world_camera;
};

struct Pair {
  std::size_t target = 0;
  std::size_t source = 0;
  Eigen::Isometry3d T_guess_error;
};

struct Settings {
  IcapOptions icap;
  QuadtreeFitterOptions plane_fit;
  CodecOptions codec;
};

std::vector<View> loadViews(const std::string& path, const Settings& settings) {
  const SequenceFolder folder = openSequenceFolder(path, {});
  QuadtreeFitter fitter(std::make_shared<const Camera>(folder.camera), settings.plane_fit);
  const std::size_t stride = std::max<std::size_t>(1, folder.pairs.size() / 60);
  std::vector<View> views;
  for (std::size_t i = 0; i < folder.pairs.size(); i += stride) {
    const std::optional<Eigen::Isometry3d> T_world_camera =
        poseAt(folder.ground_truth, folder.pairs[i].depth_stamp);
    if (!T_world_camera) continue;
    const Image<float> depth = readSequenceImages(folder, folder.pairs[i]).depth;
    // As the backend gets it: through the coder.
    const PlaneCloud cloud = quantise(fitter.fit(depth.view()), settings.codec);
    views.push_back({PlaneSet(cloud, settings.icap.planes), *T_world_camera});
  }
  return views;
}

std::vector<Pair> choosePairs(const std::vector<View>& views) {
  std::mt19937 random(7);
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < views.size(); ++i) {
    for (std::size_t j = 0; j < views.size(); ++j) {
      const Eigen::Isometry3d T = views[i].T_world_camera.inverse() * views[j].T_world_camera;
      const double distance = T.translation().norm();
      if (i == j || distance < 0.05 || distance > 0.4 || rotationAngle(T) > 30.0 * kDegree)
        continue;
      pairs.push_back({i, j, Eigen::Isometry3d::Identity()});
    }
  }
  std::shuffle(pairs.begin(), pairs.end(), random);
  pairs.resize(std::min<std::size_t>(pairs.size(), kPairs));
  for (Pair& pair : pairs) pair.T_guess_error = randomMotion(0.1, 5.0 * kDegree, random);
  return pairs;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

/// Squared error of the result in its own standard deviations, over the observed directions.
double normalisedError(const IcapResult& result, const Eigen::Isometry3d& T_true) {
  const Vector6d error = logSe3(result.T_target_source.inverse() * T_true);
  return error.dot(result.information * error) /
         static_cast<double>(6 - std::min<std::size_t>(5, result.unobserved.size()));
}

void run(const std::string& name, const std::vector<View>& views, const IcapOptions& options) {
  int good = 0;
  int degenerate = 0;
  std::vector<double> distances, angles, times, errors, overlaps, iterations;
  const std::vector<Pair> pairs = choosePairs(views);
  for (const Pair& pair : pairs) {
    const View& target = views[pair.target];
    const View& source = views[pair.source];
    const Eigen::Isometry3d T_true = target.T_world_camera.inverse() * source.T_world_camera;
    const auto start = std::chrono::steady_clock::now();
    const IcapResult result =
        icap(target.planes, source.planes, T_true * pair.T_guess_error, options);
    const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
    const Eigen::Isometry3d error = T_true.inverse() * result.T_target_source;
    const double distance = error.translation().norm();
    const double angle = rotationAngle(error) / kDegree;
    times.push_back(time.count());
    overlaps.push_back(result.overlap);
    iterations.push_back(result.iterations);
    if (distance > 0.05 || angle > 2.5) continue;
    ++good;
    degenerate += result.status == IcapStatus::kDegenerate ? 1 : 0;
    distances.push_back(1e3 * distance);
    angles.push_back(angle);
    errors.push_back(normalisedError(result, T_true));
  }
  std::printf("%-24s %-7s %3d/%3zu %6.1f %6.2f %6.2f %7.2f %6.2f %6.1f %5d\n", name.c_str(),
              toString(options.form).c_str(), good, pairs.size(), median(distances), median(angles),
              median(errors), median(overlaps), median(times), median(iterations), degenerate);
}

int runAll(int argc, char** argv) {
  Settings settings;
  OptionValues values;
  std::vector<std::string> folders;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const std::size_t equals = argument.find('=');
    if (equals == std::string::npos) {
      folders.push_back(argument);
    } else {
      values[argument.substr(0, equals)] = argument.substr(equals + 1);
    }
  }
  takeOptions(values, settings.icap, "icap/");
  takeOptions(values, settings.plane_fit, "plane_fit/");
  takeOptions(values, settings.codec, "codec/");
  if (!values.empty()) {
    std::fprintf(stderr, "unknown key: %s\n", values.begin()->first.c_str());
    return 2;
  }
  std::printf("%-24s %-7s %7s %6s %6s %6s %7s %6s %6s %5s\n", "sequence", "form", "success", "mm",
              "deg", "NEES", "overlap", "ms", "iter", "degen");
  for (const std::string& folder : folders) {
    const std::vector<View> views = loadViews(folder, settings);
    const std::string name = folder.substr(folder.find_last_of('/') + 1);
    for (const IcapForm form : {IcapForm::kPaper, IcapForm::kRobust}) {
      settings.icap.form = form;
      run(name, views, settings.icap);
    }
  }
  return 0;
}

}  // namespace
}  // namespace planecloud

int main(int argc, char** argv) { return planecloud::runAll(argc, argv); }

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Two plane clouds before and after alignment, as JSON for scripts/figures: the tiles that
// alignment uses, the guess it began with and its result.
//
//     bench_aligned_pair INPUT [--pair TARGET SOURCE] [--shift METRES] [--turn DEGREES]
#include <algorithm>
#include <array>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>

#include "planecloud_slam/icap/icap.h"
#include "planecloud_slam/plane_fit/reconstruction.h"
#include "planecloud_slam/rosbags/command_line.h"
#include "planecloud_slam/rosbags/compression_trial.h"
#include "planecloud_slam/rosbags/open_recordings.h"
#include "planecloud_slam/rosbags/trajectory_evaluation.h"
#include "planecloud_slam/rosbags/usage_error.h"

namespace planecloud {
namespace {

namespace po = boost::program_options;
using Json = nlohmann::ordered_json;

constexpr double kDegree = 3.14159265358979323846 / 180.0;  // [rad]

ToolDescription describe() {
  ToolDescription tool;
  tool.name = "bench_aligned_pair";
  tool.summary = "Prints the planes of two images before and after ICaP aligns them.";
  tool.synopsis = "INPUT [flags]";
  tool.notes = kInputHelp;
  tool.flags.add_options()(
      "pair", po::value<std::vector<int>>()->multitoken()->default_value({0, 30}, "0 30"),
      "numbers of the images, the target first, the first image is 0")(
      "shift", po::value<double>()->default_value(0.2, "0.2"),
      "of the guess from the truth, or from no motion where that is unknown, along the diagonal of "
      "the camera's axes [m]")("turn", po::value<double>()->default_value(10.0, "10"),
                               "of it, about the same [degrees]");
  addSequenceFlags(tool.flags);
  tool.arguments = {"INPUT"};
  return tool;
}

/// One image's planes, as a backend receives them.
struct View {
  double stamp = 0.0;  ///< [s]
  PlaneCloud cloud;
};

/// The images with the two numbers, in this order.
std::array<View, 2> loadViews(Recording& recording, const std::vector<int>& numbers) {
  const FrontendOptions frontend;
  CompressionTrial trial(recording.camera(), {frontend.plane_fit, frontend.codec, {}});
  std::array<View, 2> views;
  const int last = std::max(numbers[0], numbers[1]);
  for (int number = 0; number <= last; ++number) {
    CompressionItem item;
    std::optional<RgbdFrame> frame = recording.next();
    if (!frame) throw UsageError("--pair: the input has " + std::to_string(number) + " images");
    item.frame = std::move(*frame);
    for (std::size_t i = 0; i < views.size(); ++i) {
      if (numbers[i] == number) views[i] = {item.frame.stamp, trial.compress(item).cloud};
    }
  }
  return views;
}

Json listOf(const Eigen::VectorXd& numbers) {
  return std::vector<double>(numbers.data(), numbers.data() + numbers.size());
}

Json rowsOf(const Eigen::Isometry3d& T) {
  Json rows = Json::array();
  for (int row = 0; row < 4; ++row) rows.push_back(listOf(T.matrix().row(row).transpose()));
  return rows;
}

/// The tiles of a set, each as its four corners in the optical frame [m].
Json tilesOf(const PlaneSet& planes) {
  Json tiles = Json::array();
  for (const PlanePatch& patch : planes.patches(PlaneSet::Level::kWhole)) {
    const PlanarTile tile{patch.rect, (-patch.normal / patch.d).cast<float>()};
    const auto corners = tileCorners(tile, planes.camera());
    if (!corners) continue;
    Json tile_corners = Json::array();
    for (const Eigen::Vector3d& corner : *corners) tile_corners.push_back(listOf(corner));
    tiles.push_back(std::move(tile_corners));
  }
  return tiles;
}

Json errorOf(const Eigen::Isometry3d& T, const Eigen::Isometry3d& truth) {
  const Eigen::Isometry3d error = truth.inverse() * T;
  return {{"metres", error.translation().norm()}, {"degrees", rotationAngle(error) / kDegree}};
}

/// What is known of how two views lie to each other.
struct Truth {
  std::optional<Eigen::Isometry3d> T_target_source;
  Eigen::Vector3d up_target = -Eigen::Vector3d::UnitY();  ///< where nothing is known: level
};

Truth truthOf(const Trajectory& trajectory, const std::array<View, 2>& views) {
  Truth truth;
  const auto T_world_target = poseAt(trajectory, views[0].stamp);
  const auto T_world_source = poseAt(trajectory, views[1].stamp);
  if (T_world_target) truth.up_target = T_world_target->linear().row(2);
  if (T_world_target && T_world_source) {
    truth.T_target_source = T_world_target->inverse() * *T_world_source;
  }
  return truth;
}

Eigen::Isometry3d guessFrom(const Truth& truth, const ParsedFlags& flags) {
  const Eigen::Vector3d diagonal = Eigen::Vector3d::Ones().normalized();
  return truth.T_target_source.value_or(Eigen::Isometry3d::Identity()) *
         Eigen::Translation3d(flags["shift"].as<double>() * diagonal) *
         Eigen::AngleAxisd(flags["turn"].as<double>() * kDegree, diagonal);
}

Json align(const std::array<View, 2>& views, const Truth& truth, const Eigen::Isometry3d& guess) {
  const IcapOptions options;
  const PlaneSet target(views[0].cloud, options.planes);
  const PlaneSet source(views[1].cloud, options.planes);
  const IcapResult result = icap(target, source, guess, options);
  Json figure;
  figure["status"] = toString(result.status);
  figure["rms_mm"] = 1e3 * result.rms_algebraic_error;
  figure["overlap"] = result.overlap;
  if (truth.T_target_source) {
    figure["guess_error"] = errorOf(guess, *truth.T_target_source);
    figure["error"] = errorOf(result.T_target_source, *truth.T_target_source);
  }
  figure["up_target"] = listOf(truth.up_target);
  figure["T_target_source_guess"] = rowsOf(guess);
  figure["T_target_source"] = rowsOf(result.T_target_source);
  figure["target"] = tilesOf(target);
  figure["source"] = tilesOf(source);
  return figure;
}

int run(const ParsedFlags& flags) {
  const auto numbers = flags["pair"].as<std::vector<int>>();
  if (numbers.size() != 2 || numbers[0] < 0 || numbers[1] < 0) {
    throw UsageError("--pair: two numbers of images are wanted");
  }
  const auto recordings = openRecordings(flags["INPUT"].as<std::vector<std::string>>(),
                                         readSequenceFlags(flags), [](const std::string&) {});
  const std::array<View, 2> views = loadViews(*recordings.front(), numbers);
  const Truth truth = truthOf(recordings.front()->groundTruth(), views);
  std::cout << align(views, truth, guessFrom(truth, flags)).dump() << '\n';
  return 0;
}

}  // namespace
}  // namespace planecloud

int main(int argc, char** argv) {
  return planecloud::runTool(planecloud::describe(), argc, argv, planecloud::run);
}

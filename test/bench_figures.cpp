// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What scripts/figures draws beside our own curves, as JSON: the paper's algorithm as time goes on,
// and other depth codecs at several errors.
//
//     bench_figures INPUT [--every N] [--max-images N] [--tolerance METRES] [--min-tile PX]
#include <algorithm>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>

#include "depth_codec_peers.h"
#include "plane_fit_peers.h"
#include "planecloud_slam/rosbags/command_line.h"
#include "planecloud_slam/rosbags/compression_source.h"
#include "planecloud_slam/rosbags/open_recordings.h"
#include "planecloud_slam/rosbags/usage_error.h"

namespace planecloud {
namespace {

namespace po = boost::program_options;
using Json = nlohmann::ordered_json;

constexpr int kBudgets = 12;
constexpr double kErrors[] = {0.002, 0.003, 0.005, 0.008};  // [m]

ToolDescription describe() {
  ToolDescription tool;
  tool.name = "bench_figures";
  tool.summary = "Prints what scripts/figures draws beside the curves of compress.";
  tool.synopsis = "INPUT [flags]";
  tool.notes = kInputHelp;
  tool.flags.add_options()("every", po::value<int>()->default_value(1),
                           "take only each N-th image")(
      "max-images", po::value<int>()->default_value(0), "take at most so many, 0: all")(
      "tolerance", po::value<double>()->default_value(0.0131, "0.0131"), "of the paper's fit [m]")(
      "min-tile", po::value<int>()->default_value(8), "of the paper's fit [px]")(
      "peers", po::bool_switch(), "code the images with other codecs, too: slow");
  addSequenceFlags(tool.flags);
  tool.arguments = {"INPUT"};
  return tool;
}

std::vector<Image<float>> loadDepth(CompressionSource& source) {
  std::vector<Image<float>> images;
  while (std::optional<CompressionItem> item = source.next()) {
    images.push_back(std::move(item->frame.depth));
  }
  if (images.empty()) throw UsageError("the input has no images");
  return images;
}

double validPixels(const Image<float>& depth) {
  return static_cast<double>(
      std::count_if(depth.begin(), depth.end(), [](float z) { return z > 0.0F; }));
}

/// Mean [ms, coverage, planes] for budgets evenly spread over what the longest image takes.
Json paperCurve(const std::vector<Image<float>>& images, const Camera& camera,
                const ParsedFlags& flags) {
  std::vector<std::vector<FitProgress>> runs;
  double longest = 0.0;
  for (const Image<float>& depth : images) {
    runs.push_back(
        watchThePaper(depth, camera, flags["tolerance"].as<double>(), flags["min-tile"].as<int>()));
    longest = std::max(longest, runs.back().back().milliseconds);
  }
  Json curve = Json::array();
  const auto count = static_cast<double>(images.size());
  for (int i = 1; i <= kBudgets; ++i) {
    const double budget = longest * i / kBudgets;
    double coverage = 0.0;
    double planes = 0.0;
    for (std::size_t run = 0; run < runs.size(); ++run) {
      const auto after = std::upper_bound(
          runs[run].begin(), runs[run].end(), budget,
          [](double time, const FitProgress& progress) { return time < progress.milliseconds; });
      const FitProgress& reached = *std::prev(after);
      coverage += reached.covered / std::max(1.0, validPixels(images[run])) / count;
      planes += static_cast<double>(reached.planes) / count;
    }
    curve.push_back({budget, coverage, planes});
  }
  return curve;
}

/// Mean [bytes, error in mm] of each codec that is there.
Json peerCurves(const std::vector<Image<float>>& images, const Camera& camera) {
  std::map<std::string, Json> curves;
  const auto count = static_cast<double>(images.size());
  for (const double error : kErrors) {
    std::map<std::string, CodedDepth> sums;
    for (const Image<float>& depth : images) {
      const std::pair<const char*, CodedDepth> coded[] = {
          {"JPEG 2000 on 16-bit inverse depth", encodeJpeg2000(depth, error)},
          {"Draco, k-d tree", encodeDraco(depth, camera, error)}};
      for (const auto& [name, one] : coded) {
        if (one.bytes == 0) continue;
        sums[name].bytes += one.bytes;
        sums[name].depth_error += one.depth_error;
      }
    }
    for (const auto& [name, sum] : sums) {
      curves[name].push_back(
          {static_cast<double>(sum.bytes) / count, 1e3 * sum.depth_error / count});
    }
  }
  return curves;
}

int run(const ParsedFlags& flags) {
  const auto recordings = openRecordings(flags["INPUT"].as<std::vector<std::string>>(),
                                         readSequenceFlags(flags), [](const std::string&) {});
  CompressionSelection selection;
  selection.every = static_cast<std::size_t>(std::max(1, flags["every"].as<int>()));
  selection.max_images = static_cast<std::size_t>(std::max(0, flags["max-images"].as<int>()));
  const auto source = makeCompressionSource(recordings.front(), selection, FrontendOptions());
  const Camera camera(source->camera());
  const std::vector<Image<float>> images = loadDepth(*source);
  Json figures;
  figures["paper"] = paperCurve(images, camera, flags);
  if (flags["peers"].as<bool>()) figures["peers"] = peerCurves(images, camera);
  std::cout << figures.dump(2) << '\n';
  return 0;
}

}  // namespace
}  // namespace planecloud

int main(int argc, char** argv) {
  return planecloud::runTool(planecloud::describe(), argc, argv, planecloud::run);
}

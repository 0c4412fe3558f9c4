// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <optional>

#include "planecloud_slam/rosbags/command_line.h"
#include "planecloud_slam/rosbags/compression_pictures.h"
#include "planecloud_slam/rosbags/compression_report.h"
#include "planecloud_slam/rosbags/compression_source.h"
#include "planecloud_slam/rosbags/compression_trial.h"
#include "planecloud_slam/rosbags/open_recordings.h"
#include "planecloud_slam/rosbags/progress_bar.h"
#include "planecloud_slam/rosbags/usage_error.h"

namespace planecloud {
namespace {

namespace po = boost::program_options;

void addFitFlags(po::options_description& flags) {
  const CompressionOptions defaults;
  const auto text = [](const auto& value) { return toString(value); };
  flags.add_options()("tolerance",
                      po::value<double>()->default_value(defaults.plane_fit.tolerance, "0.003"),
                      "allowed mean error of a tile at 1 m [m]")(
      "acceptance", po::value<std::string>()->default_value(text(defaults.plane_fit.acceptance)),
      "how the tolerance grows with depth: fixed, linear_in_depth or noise_scaled")(
      "initial-tile", po::value<int>()->default_value(defaults.plane_fit.initial_tile_width),
      "side of the largest tiles [px]")(
      "min-tile", po::value<int>()->default_value(defaults.plane_fit.min_tile),
      "side of the smallest tiles [px]")(
      "encoding", po::value<std::string>()->default_value(text(defaults.codec.encoding)),
      "raw (the paper's 32 bytes a plane), compact or lossless (the depth itself)")(
      "lambda", po::value<double>()->default_value(defaults.plane_fit.lambda, "6"),
      "what a bit must save: error in tolerances, summed over pixels; 0: tolerance alone decides")(
      "mask", po::bool_switch(), "also send which pixels had depth, exactly")(
      "texture", po::value<std::string>()->default_value("none"),
      "what of the image goes with the planes: none, grey or color")(
      "time-budget", po::value<double>()->default_value(0.0), "for each fit [s], 0: none")(
      "byte-budget", po::value<int>()->default_value(0),
      "for planes and texture of each image [B], 0: none");
}

ToolDescription describe() {
  ToolDescription tool;
  tool.name = "compress";
  tool.summary = "Turns the depth images of an input into planes and back, and says what it costs.";
  tool.synopsis = "INPUT [flags]";
  tool.notes = kInputHelp;
  addFitFlags(tool.flags);
  addSequenceFlags(tool.flags);
  tool.flags.add_options()(
      "keyframes", po::bool_switch(),
      "compress the keyframes that tracking would send, their depth fused with "
      "that of the images in between, instead of every image")(
      "every", po::value<int>()->default_value(1), "take only each N-th image")(
      "max-images", po::value<int>()->default_value(0), "take at most so many, 0: all")(
      "pictures", po::value<std::string>()->value_name("DIR"),
      "writes colour, depth, restored depth, error, tiles and texture of each image as PNG")(
      "json", po::bool_switch(), "print the figures as JSON")(
      "csv", po::value<std::string>()->value_name("F"), "writes a line of figures per image");
  tool.arguments = {"INPUT"};
  return tool;
}

CompressionOptions readOptions(const ParsedFlags& flags) {
  CompressionOptions options;
  options.plane_fit.tolerance = flags["tolerance"].as<double>();
  options.plane_fit.initial_tile_width = options.plane_fit.initial_tile_height =
      flags["initial-tile"].as<int>();
  options.plane_fit.min_tile = flags["min-tile"].as<int>();
  options.plane_fit.time_budget = flags["time-budget"].as<double>();
  options.plane_fit.lambda = flags["lambda"].as<double>();
  options.codec.mask = flags["mask"].as<bool>();
  options.codec.byte_budget = flags["byte-budget"].as<int>();
  try {
    fromString(flags["acceptance"].as<std::string>(), options.plane_fit.acceptance);
    fromString(flags["encoding"].as<std::string>(), options.codec.encoding);
    fromString(flags["texture"].as<std::string>(), options.texture.format);
    // A plane costs 32 bytes in RAW, so the fit itself can stop; COMPACT knows only when coding.
    if (options.codec.encoding == PlaneCloudEncoding::kRaw) {
      options.plane_fit.byte_budget = options.codec.byte_budget;
    }
    options.plane_fit.check();
    options.codec.check();
  } catch (const std::invalid_argument& error) {
    throw UsageError(error.what());
  }
  return options;
}

CompressionSelection readSelection(const ParsedFlags& flags, const CompressionOptions& options) {
  const int every = flags["every"].as<int>();
  const int max_images = flags["max-images"].as<int>();
  if (every < 1) throw UsageError("--every " + std::to_string(every) + ": must be at least 1");
  if (max_images < 0) {
    throw UsageError("--max-images " + std::to_string(max_images) + ": must be at least 0");
  }
  CompressionSelection selection;
  selection.keyframes = flags["keyframes"].as<bool>();
  selection.color = options.texture.format == TextureFormat::kColor;
  selection.every = static_cast<std::size_t>(every);
  selection.max_images = static_cast<std::size_t>(max_images);
  return selection;
}

/// What is written while frames come.
class CompressionOutput {
 public:
  explicit CompressionOutput(const ParsedFlags& flags) {
    if (flags.count("csv") != 0) {
      csv_path_ = flags["csv"].as<std::string>();
      csv_.open(csv_path_);
      csv_ << CompressionReport::csvHeader() << '\n';
    }
    if (flags.count("pictures") != 0) {
      pictures_ = flags["pictures"].as<std::string>();
      std::filesystem::create_directories(pictures_);
    }
  }

  void write(std::size_t index, const CompressionItem& item, const CompressedFrame& compressed) {
    if (csv_.is_open()) csv_ << CompressionReport::csvLine(compressed) << '\n';
    if (pictures_.empty()) return;
    char number[16];
    std::snprintf(number, sizeof(number), "_%06zu", index);
    writePictures(pictures_ + "/" + compressed.robot + number, item, compressed);
  }

  void close() {
    if (csv_path_.empty()) return;
    csv_.close();
    if (!csv_) throw std::runtime_error("cannot write '" + csv_path_ + "'");
  }

 private:
  std::string csv_path_;
  std::ofstream csv_;
  std::string pictures_;
};

/// A frontend that compresses as these options say.
FrontendOptions frontendOf(const CompressionOptions& options) {
  FrontendOptions frontend;
  frontend.plane_fit = options.plane_fit;
  frontend.codec = options.codec;
  frontend.texture = options.texture;
  return frontend;
}

CompressionReport compressAll(const std::vector<std::shared_ptr<Recording>>& recordings,
                              const CompressionSelection& selection,
                              const CompressionOptions& options, CompressionOutput& output) {
  CompressionReport report;
  for (const auto& recording : recordings) {
    const auto source = makeCompressionSource(recording, selection, frontendOf(options));
    CompressionTrial trial(source->camera(), options);
    ProgressBar progress("compress " + recording->robot(), recording->size());
    std::size_t images_read = 0;
    for (std::size_t index = 0; std::optional<CompressionItem> item = source->next(); ++index) {
      CompressedFrame compressed = trial.compress(*item);
      compressed.robot = recording->robot();
      report.add(compressed);
      output.write(index, *item, compressed);
      for (; images_read < source->imagesRead(); ++images_read) progress.advance();
    }
  }
  return report;
}

int compress(const ParsedFlags& flags) {
  const auto inputs = flags["INPUT"].as<std::vector<std::string>>();
  if (inputs.size() != 1) throw UsageError("one INPUT at a time");
  const CompressionOptions options = readOptions(flags);
  const auto recordings =
      openRecordings(inputs, readSequenceFlags(flags),
                     [](const std::string& text) { std::cerr << "compress: " << text << '\n'; });
  CompressionOutput output(flags);
  const CompressionReport report =
      compressAll(recordings, readSelection(flags, options), options, output);
  output.close();
  if (report.images() == 0) throw std::runtime_error(kNoPairs);
  if (flags["json"].as<bool>()) {
    std::cout << report.json().dump(2) << '\n';
  } else {
    std::cout << report.table();
  }
  return 0;
}

}  // namespace
}  // namespace planecloud

int main(int argc, char** argv) {
  return planecloud::runTool(planecloud::describe(), argc, argv, planecloud::compress);
}

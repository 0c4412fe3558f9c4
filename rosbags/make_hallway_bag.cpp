// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <boost/program_options.hpp>
#include <string>

#include "planecloud_slam/rosbags/command_line.h"
#include "planecloud_slam/rosbags/hallway_bag.h"
#include "planecloud_slam/rosbags/progress_bar.h"
#include "planecloud_slam/rosbags/usage_error.h"

namespace planecloud {
namespace {

namespace po = boost::program_options;

ToolDescription description() {
  ToolDescription tool;
  tool.name = "make_hallway_bag";
  tool.summary =
      "Renders the built-in world, a textured hallway around a block, into a bag: images, camera\n"
      "info, tf, wheel odometry and ground truth of one or several robots.";
  tool.synopsis = "--output F.bag [flags]";
  tool.flags.add_options()("output", po::value<std::string>()->required()->value_name("F.bag"),
                           "file to write")(
      "robots", po::value<int>()->default_value(1)->value_name("N"),
      "robots that record at the same time, 1 to 16; with several each has its namespace")(
      "seed", po::value<std::uint64_t>()->default_value(1)->value_name("S"),
      "changes textures, furniture, paths and noise")(
      "duration",
      po::value<double>()->default_value(HallwayOptions{}.duration)->value_name("SECONDS"),
      "length of the recording; a round takes about 74 s")(
      "noise", po::value<std::string>()->default_value("astra")->value_name("astra|none"),
      "sensor model; none: exact depth in millimetres")(
      "color", po::bool_switch(), "rgb8 images instead of mono8: half as much again on the disk");
  return tool;
}

HallwayBagOptions optionsOf(const ParsedFlags& flags) {
  HallwayBagOptions bag;
  bag.color = flags["color"].as<bool>();
  HallwayOptions& options = bag.world;
  options.seed = flags["seed"].as<std::uint64_t>();
  options.robots = flags["robots"].as<int>();
  options.duration = flags["duration"].as<double>();
  checkFlag("robots", options.robots, 1, 16);
  checkFlag("duration", options.duration, 0.1, 3600.0);
  const auto noise = flags["noise"].as<std::string>();
  if (noise != "astra" && noise != "none") {
    throw UsageError("--noise = " + noise + ": must be astra or none");
  }
  options.noise = noise == "astra";
  return bag;
}

int run(const ParsedFlags& flags) {
  const HallwayBagOptions options = optionsOf(flags);
  const double pairs =
      options.world.duration * HallwayRecording::kFramesPerSecond * options.world.robots;
  ProgressBar progress("rendering", static_cast<std::size_t>(pairs) + 1);
  writeHallwayBag(options, flags["output"].as<std::string>(), [&] { progress.advance(); });
  return 0;
}

}  // namespace
}  // namespace planecloud

int main(int argc, char** argv) {
  return planecloud::runTool(planecloud::description(), argc, argv, planecloud::run);
}

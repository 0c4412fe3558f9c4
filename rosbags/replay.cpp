// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>

#include "planecloud_slam/rosbags/command_line.h"
#include "planecloud_slam/rosbags/open_recordings.h"
#include "planecloud_slam/rosbags/progress_bar.h"
#include "planecloud_slam/rosbags/replay_config.h"
#include "planecloud_slam/rosbags/replay_output.h"
#include "planecloud_slam/rosbags/replay_run.h"

namespace planecloud {
namespace {

namespace po = boost::program_options;

ToolDescription describe() {
  ToolDescription tool;
  tool.name = "replay";
  tool.summary =
      "Runs frontends and backend over recordings in one process: no master, no dropped frames,\n"
      "the same result every time.";
  tool.synopsis = "INPUT... --output DIR [flags]";
  tool.notes = std::string(kInputHelp) +
               "\n\nWrites DIR/<robot>_frames.txt and <robot>_keyframes.txt (optimised, TUM "
               "format), <robot>_odometry.txt\n(tracking only), <robot>_groundtruth.txt when the "
               "input has it, map.ply, map.png, report.json.\nTime budgets are ignored, byte "
               "budgets obeyed.";
  tool.flags.add_options()("output", po::value<std::string>()->required()->value_name("DIR"),
                           "folder for the results; made if needed")(
      "config", po::value<std::vector<std::string>>()->composing()->value_name("YAML"),
      "parameters of the frontend or the backend, as the nodes load them; may be repeated");
  addSequenceFlags(tool.flags);
  tool.flags.add_options()("max-frames", po::value<long>()->value_name("N"),
                           "frames taken from each recording, default all")(
      "keyframe-spacing", po::value<double>()->value_name("METRES"),
      "sets keyframe/max_translation")("no-loop-closure", po::bool_switch(),
                                       "no loop closures: odometry and history only")(
      "no-history", po::bool_switch(), "keyframes keep only the edge to the previous one")(
      "threads", po::value<int>()->value_name("N"),
      "threads used at most, default one per core; does not change the result");
  tool.arguments = {"INPUT"};
  return tool;
}

ReplayOptions readOptions(const ParsedFlags& flags) {
  ReplayConfig config;
  if (flags.count("config") != 0) {
    for (const auto& path : flags["config"].as<std::vector<std::string>>()) {
      loadConfig(path, config);
    }
  }
  ReplayOptions options;
  options.robots.frontend = config.frontend.frontend;
  options.backend = config.backend.backend;
  if (flags.count("keyframe-spacing") != 0) {
    const auto spacing = flags["keyframe-spacing"].as<double>();
    checkFlag("keyframe-spacing", spacing, 0.01, 10.0);
    options.robots.frontend.keyframe.max_translation = spacing;
  }
  if (flags.count("max-frames") != 0) {
    const auto frames = flags["max-frames"].as<long>();
    checkFlag("max-frames", static_cast<double>(frames), 1.0, 1e9);
    options.robots.max_frames = static_cast<std::size_t>(frames);
  }
  options.threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  if (flags.count("threads") != 0) {
    options.threads = flags["threads"].as<int>();
    checkFlag("threads", options.threads, 1.0, 256.0);
  }
  options.robots.history = !flags["no-history"].as<bool>();
  if (flags["no-loop-closure"].as<bool>()) options.backend.loop_closure.candidates.enabled = false;
  return options;
}

/// Frames that will be replayed; 0 when a recording does not know.
std::size_t countFrames(const std::vector<std::shared_ptr<Recording>>& recordings,
                        std::size_t max_frames) {
  std::size_t count = 0;
  for (const auto& recording : recordings) {
    if (recording->size() == 0) return 0;
    count += max_frames > 0 ? std::min(max_frames, recording->size()) : recording->size();
  }
  return count;
}

/// Throws std::runtime_error when there is nothing to map, saying what may be the matter.
void checkKeyframes(const ReplayResult& result) {
  std::size_t frames = 0;
  for (const RobotLog& log : result.robots) frames += log.frames.size();
  if (frames == 0) {
    throw std::runtime_error(kNoPairs);
  }
  const auto& nodes = result.map->nodes;
  const bool has_planes = std::any_of(nodes.begin(), nodes.end(), [](const auto& node) {
    return node.keyframe->planes.count() > 0;
  });
  if (has_planes) return;
  throw std::runtime_error("none of the " + std::to_string(frames) +
                           " frames has a plane: is the depth empty, or the depth scale wrong "
                           "(--depth-scale, depth_scale in camera.yaml)?");
}

int replay(const ParsedFlags& flags) {
  ReplayOptions options = readOptions(flags);
  const auto folder = flags["output"].as<std::string>();
  std::filesystem::create_directories(folder);  // a replay takes too long to fail at its end
  const auto note = [](const std::string& text) { std::cerr << "replay: " << text << '\n'; };
  const auto recordings =
      openRecordings(flags["INPUT"].as<std::vector<std::string>>(), readSequenceFlags(flags), note);
  ReplayResult result;
  {
    ProgressBar progress("replay", countFrames(recordings, options.robots.max_frames));
    options.on_frame = [&] { progress.advance(); };
    options.on_note = [&](const std::string& text) { progress.print("replay: " + text); };
    result = runReplay(recordings, options);
  }
  checkKeyframes(result);
  const JudgedReplay judged = judgeReplay(std::move(result));
  writeReplay(folder, judged);
  std::cout << summarise(judged) << "written    " << folder
            << "/ (map.png, map.ply, report.json, trajectories)\n";
  return 0;
}

}  // namespace
}  // namespace planecloud

int main(int argc, char** argv) {
  return planecloud::runTool(planecloud::describe(), argc, argv, planecloud::replay);
}

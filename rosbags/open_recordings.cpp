// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/rosbags/open_recordings.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <iostream>
#include <set>
#include <utility>

#include "planecloud_slam/rosbags/camera_file.h"
#include "planecloud_slam/rosbags/hallway_recording.h"
#include "planecloud_slam/rosbags/sequence_recording.h"
#include "planecloud_slam/rosbags/usage_error.h"

#ifdef PLANECLOUD_SLAM_WITH_BAGS
#include "planecloud_slam/rosbags/bag_recording.h"
#endif

namespace planecloud {
namespace {

namespace po = boost::program_options;
using Recordings = std::vector<std::shared_ptr<Recording>>;
using Warn = std::function<void(const std::string&)>;

const std::string kHallwayPrefix = "hallway:";
constexpr int kMostHallwayRobots = 16;

bool endsWith(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// A recording of another robot's name: two inputs may both have a robot1.
class RenamedRecording : public Recording {
 public:
  RenamedRecording(std::shared_ptr<Recording> recording, std::string robot)
      : recording_(std::move(recording)), robot_(std::move(robot)) {}

  [[nodiscard]] const std::string& robot() const override { return robot_; }
  [[nodiscard]] const CameraIntrinsics& camera() const override { return recording_->camera(); }
  [[nodiscard]] std::size_t size() const override { return recording_->size(); }
  [[nodiscard]] std::optional<RgbdFrame> next() override { return recording_->next(); }
  [[nodiscard]] const Trajectory& groundTruth() const override { return recording_->groundTruth(); }
  [[nodiscard]] std::optional<Image<float>> trueDepth() const override {
    return recording_->trueDepth();
  }
  [[nodiscard]] cv::Mat color() const override { return recording_->color(); }

 private:
  const std::shared_ptr<Recording> recording_;
  const std::string robot_;
};

/// The whole of `text` as a number; nothing else may stand around it.
template <typename Number>
bool parseWhole(const std::string& text, Number& number) {
  const char* const end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, number);
  return result.ec == std::errc() && result.ptr == end;
}

Recordings openHallway(const std::string& input) {
  const std::string text = input.substr(kHallwayPrefix.size());
  const std::size_t colon = text.find(':');
  HallwayOptions options;
  const bool has_seed = parseWhole(text.substr(0, colon), options.seed);
  const bool has_robots =
      colon == std::string::npos || parseWhole(text.substr(colon + 1), options.robots);
  if (!has_seed || !has_robots || options.robots < 1 || options.robots > kMostHallwayRobots) {
    throw UsageError("'" + input +
                     "': expected hallway:SEED or hallway:SEED:ROBOTS, e.g. "
                     "hallway:1:2, with 1 to 16 robots");
  }
  Recordings recordings;
  for (auto& recording : makeHallwayRecordings(options)) recordings.push_back(std::move(recording));
  return recordings;
}

#ifdef PLANECLOUD_SLAM_WITH_BAGS
Recordings openBagFile(const std::string& input, const Warn& warn) {
  Recordings recordings;
  for (auto& recording : openBag(input, warn)) recordings.push_back(std::move(recording));
  return recordings;
}
#else
Recordings openBagFile(const std::string& input, const Warn&) {
  throw UsageError("'" + input +
                   "': this build has no ROS and cannot read bags; build the package in a catkin "
                   "workspace");
}
#endif

Recordings openInput(const std::string& input, const SequenceOptions& options, const Warn& warn) {
  if (input.rfind(kHallwayPrefix, 0) == 0) return openHallway(input);
  if (endsWith(input, ".bag")) return openBagFile(input, warn);
  if (std::filesystem::is_directory(input)) {
    return {std::make_shared<SequenceRecording>(openSequenceFolder(input, options), "robot1")};
  }
  throw UsageError("'" + input +
                   "' is no input: there is no such folder, and it is neither a .bag "
                   "nor hallway:SEED[:ROBOTS]");
}

/// `name`, or where it is taken the first robotN that is not.
std::string freeName(const std::string& name, const std::set<std::string>& taken) {
  if (taken.count(name) == 0) return name;
  int number = 2;
  while (taken.count("robot" + std::to_string(number)) != 0) ++number;
  return "robot" + std::to_string(number);
}

}  // namespace

const char* const kInputHelp =
    "An INPUT is a .bag, a folder in the layout of the TUM RGB-D benchmark (associations.txt, "
    "rgb/,\n"
    "depth/, optional groundtruth.txt and camera.yaml), or hallway:SEED[:ROBOTS], the built-in\n"
    "world rendered on the fly.";

const char* const kNoPairs =
    "the input has no pair of a colour and a depth image (in bags: taken within 20 ms of each "
    "other)";

void addSequenceFlags(po::options_description& flags) {
  flags.add_options()("camera",
                      po::value<std::string>()->value_name("FX,FY,CX,CY[,K1,K2,P1,P2,K3]"),
                      "camera of a folder; goes before its camera.yaml")(
      "depth-scale", po::value<double>()->value_name("N"),
      "depth pixels per metre of a folder; goes before its camera.yaml, default 5000");
}

SequenceOptions readSequenceFlags(const po::variables_map& flags) {
  SequenceOptions options;
  if (flags.count("camera") != 0) {
    options.camera = parseCameraFlag(flags["camera"].as<std::string>());
  }
  if (flags.count("depth-scale") != 0) options.depth_scale = flags["depth-scale"].as<double>();
  return options;
}

Recordings openRecordings(const std::vector<std::string>& inputs, const SequenceOptions& options,
                          const Warn& warn) {
  Recordings all;
  std::set<std::string> names;
  for (const std::string& input : inputs) {
    for (std::shared_ptr<Recording>& recording : openInput(input, options, warn)) {
      const std::string name = freeName(recording->robot(), names);
      names.insert(name);
      if (name != recording->robot()) {
        recording = std::make_shared<RenamedRecording>(std::move(recording), name);
      }
      all.push_back(std::move(recording));
    }
  }
  return all;
}

}  // namespace planecloud

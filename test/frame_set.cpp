// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "frame_set.h"

#include "planecloud_slam/rosbags/hallway_recording.h"
#include "planecloud_slam/rosbags/sequence_recording.h"

namespace planecloud {
namespace {

constexpr double kLoopSeconds = 84.0;
constexpr double kCorridorSeconds = 38.0;

void readFrames(Recording& recording, std::size_t max_frames, FrameSet& set) {
  set.camera = recording.camera();
  set.truth = recording.groundTruth();
  while (max_frames == 0 || set.frames.size() < max_frames) {
    std::optional<RgbdFrame> frame = recording.next();
    if (!frame) return;
    set.frames.push_back(std::make_shared<const RgbdFrame>(std::move(*frame)));
  }
}

/// What the wheels say between the frames; they report at a multiple of the frames' rate.
void addWheels(const HallwayRecording& recording, FrameSet& set) {
  constexpr std::size_t kStep =
      HallwayRecording::kOdometryPerSecond / HallwayRecording::kFramesPerSecond;
  const Eigen::Isometry3d T_base_camera = HallwayRecording::T_base_camera();
  set.T_base_camera = T_base_camera;
  set.wheels.resize(set.frames.size());
  for (std::size_t i = 1; i < set.frames.size() && i * kStep < recording.odometry().size(); ++i) {
    const Eigen::Isometry3d T_odom_previous = toTransform(recording.odometry()[(i - 1) * kStep]);
    const Eigen::Isometry3d T_odom_current = toTransform(recording.odometry()[i * kStep]);
    set.wheels[i] =
        T_base_camera.inverse() * T_odom_previous.inverse() * T_odom_current * T_base_camera;
  }
}

FrameSet loadHallway(std::uint64_t seed, bool corridor, std::size_t max_frames) {
  HallwayOptions options;
  options.seed = seed;
  options.duration = corridor ? kCorridorSeconds : kLoopSeconds;
  if (corridor) options.drive = DriveKind::kHallway;
  HallwayRecording recording(options);
  FrameSet set;
  readFrames(recording, max_frames, set);
  addWheels(recording, set);
  return set;
}

}  // namespace

FrameSet loadFrameSet(const std::string& input, std::size_t max_frames) {
  FrameSet set;
  const std::size_t colon = input.find(':');
  const std::string kind = input.substr(0, colon);
  if (colon != std::string::npos && (kind == "hallway" || kind == "corridor")) {
    set = loadHallway(std::stoull(input.substr(colon + 1)), kind == "corridor", max_frames);
    set.name = input;
    return set;
  }
  SequenceRecording recording(openSequenceFolder(input, {}), "robot1");
  readFrames(recording, max_frames, set);
  const std::size_t end = input.find_last_not_of('/');
  const std::size_t slash = input.find_last_of('/', end);
  set.name = input.substr(slash == std::string::npos ? 0 : slash + 1, end - slash);
  return set;
}

}  // namespace planecloud

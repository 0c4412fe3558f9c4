// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <filesystem>

#include "frame_set.h"
#include "planecloud_slam/rosbags/hallway_recording.h"
#include "recorded_depth.h"
#include "tracking_trials.h"

namespace planecloud {
namespace {

constexpr std::uint64_t kSeed = 1;
constexpr std::size_t kFrames = 165;  // 11 s

CameraIntrinsics halfCamera() {
  CameraIntrinsics camera = astraCamera();
  camera.width /= 2;
  camera.height /= 2;
  camera.fx = camera.fy = camera.fx / 2.0;
  camera.cx = 159.5;
  camera.cy = 119.5;
  return camera;
}

/// The drive down the hallway, from when the robot has its speed.
FrameSet hallway() {
  HallwayOptions options;
  options.seed = kSeed;
  options.duration = 15.0;
  options.camera = halfCamera();
  HallwayRecording recording(options);
  FrameSet set;
  set.camera = recording.camera();
  set.truth = recording.groundTruth();
  for (std::size_t i = 0; i < 60; ++i) (void)recording.next();
  while (set.frames.size() < kFrames) {
    set.frames.push_back(std::make_shared<const RgbdFrame>(*recording.next()));
  }
  return set;
}

TrialOutcome run(const Trial& trial) {
  Frontend frontend(FrontendOptions{}, trial.set.camera, "robot1", 1);
  std::vector<FrameResult> results;
  for (const auto& frame : trial.set.frames) results.push_back(frontend.track(*frame));
  frontend.finish();
  KeyframeStamps stamps;
  for (const CompletedKeyframe& completed : frontend.takeCompleted()) {
    stamps[completed.keyframe.id] = completed.keyframe.stamp;
  }
  return judgeTrial(trial, results, stamps);
}

void expectNoticedAndEndedSoon(const FrameSet& set) {
  for (const Trial& trial : makeTrials(set, kSeed)) {
    const TrialOutcome outcome = run(trial);
    EXPECT_EQ(outcome.wrong, 0U) << trial.name << ": " << outcome.worst << " m";
    EXPECT_EQ(outcome.blind_good, 0U) << trial.name;
    if (!outcome.seen_before) continue;
    EXPECT_LE(outcome.regained_after, 1.0) << trial.name;
    EXPECT_TRUE(outcome.same_segment) << trial.name;
  }
}

TEST(TrackingTrials, LossIsNoticedAndEndsSoon) { expectNoticedAndEndedSoon(hallway()); }

TEST(TrackingTrials, LossInARecordingIsNoticedAndEndsSoon) {
  const std::filesystem::path folder = recordedDataFolder() / "tum_fr1_xyz_first_300";
  if (!std::filesystem::exists(folder))
    GTEST_SKIP() << "no recording in " << folder << ": set PLANECLOUD_SLAM_DATA";
  expectNoticedAndEndedSoon(loadFrameSet(folder.string()));
}

TEST(TrackingTrials, AFastTurnIsFollowedOrRegained) {
  const TrialOutcome outcome = run(makeFastTurn(kSeed, halfCamera()));
  EXPECT_EQ(outcome.wrong, 0U) << outcome.worst << " m";
  EXPECT_LE(outcome.regained_after, 1.0);
}

}  // namespace
}  // namespace planecloud

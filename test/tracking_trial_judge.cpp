// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "planecloud_slam/rosbags/trajectory_evaluation.h"
#include "tracking_trials.h"

namespace planecloud {
namespace {

constexpr double kWrong = 0.1;      // [m]
constexpr double kSeenShare = 0.5;  // of the view that makes it a view seen before
constexpr int kSampleStep = 16;     // [px]
constexpr double kSameDepth = 0.1;  // relative
constexpr double kNever = 1e9;      // [s]

/// Share of what `frame` shows that `other` shows too, by the true poses.
double sharedView(const RgbdFrame& frame, const RgbdFrame& other,
                  const Eigen::Isometry3d& T_other_frame, const CameraIntrinsics& camera) {
  const CameraIntrinsics pinhole = camera.rectified();
  double points = 0.0;
  double shared = 0.0;
  for (int y = kSampleStep / 2; y < camera.height; y += kSampleStep) {
    for (int x = kSampleStep / 2; x < camera.width; x += kSampleStep) {
      const double z = frame.depth(x, y);
      if (!(z > 0.0)) continue;
      points += 1.0;
      const Eigen::Vector3d point =
          T_other_frame *
          Eigen::Vector3d(z * (x - pinhole.cx) / pinhole.fx, z * (y - pinhole.cy) / pinhole.fy, z);
      if (point.z() < 0.1) continue;
      const Eigen::Vector2d pixel = projectPoint(pinhole, point);
      const auto column = static_cast<int>(std::lround(pixel.x()));
      const auto row = static_cast<int>(std::lround(pixel.y()));
      if (column < 0 || column >= camera.width || row < 0 || row >= camera.height) continue;
      const double seen = other.depth(column, row);
      shared += std::abs(seen - point.z()) < kSameDepth * point.z() ? 1.0 : 0.0;
    }
  }
  return points > 0.0 ? shared / points : 0.0;
}

/// True when the first good image shows what a frame that became a keyframe had shown.
bool isSeenBefore(const Trial& trial, const KeyframeStamps& stamps) {
  if (trial.end >= trial.set.frames.size()) return false;
  const RgbdFrame& live = *trial.set.frames[trial.end];
  const auto T_world_live = poseAt(trial.set.truth, live.stamp);
  if (!T_world_live) return false;
  for (std::size_t i = 0; i < trial.begin; ++i) {
    const RgbdFrame& frame = *trial.set.frames[i];
    const bool is_keyframe = std::any_of(stamps.begin(), stamps.end(), [&](const auto& entry) {
      return std::abs(entry.second - frame.stamp) < 1e-6;
    });
    const auto T_world_frame = poseAt(trial.set.truth, frame.stamp);
    if (!is_keyframe || !T_world_frame) continue;
    if (sharedView(live, frame, T_world_frame->inverse() * *T_world_live, trial.set.camera) >=
        kSeenShare) {
      return true;
    }
  }
  return false;
}

}  // namespace

TrialOutcome judgeTrial(const Trial& trial, const std::vector<FrameResult>& results,
                        const KeyframeStamps& stamps) {
  TrialOutcome outcome;
  outcome.seen_before = isSeenBefore(trial, stamps);
  outcome.regained_after = kNever;
  outcome.same_segment = true;
  const int segment = results[trial.begin - 1].segment;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const FrameResult& result = results[i];
    outcome.segments = std::max(outcome.segments, result.segment + 1);
    if (result.status == TrackingStatus::kLost) continue;
    outcome.blind_good += trial.is_blind && i >= trial.begin && i < trial.end ? 1U : 0U;
    if (i >= trial.end && result.segment == segment) {
      outcome.regained_after =
          std::min(outcome.regained_after, result.stamp - results[trial.end].stamp);
    }
    outcome.same_segment = outcome.same_segment && result.segment == segment;
    const auto reference = stamps.find(result.reference);
    if (reference == stamps.end()) continue;
    const auto T_world_reference = poseAt(trial.set.truth, reference->second);
    const auto T_world_camera = poseAt(trial.set.truth, result.stamp);
    if (!T_world_reference || !T_world_camera) continue;
    const Eigen::Isometry3d T_truth = T_world_reference->inverse() * *T_world_camera;
    const double error = (T_truth.translation() - result.T_reference_camera.translation()).norm();
    outcome.worst = std::max(outcome.worst, error);
    outcome.wrong += error > kWrong ? 1U : 0U;
  }
  return outcome;
}

}  // namespace planecloud

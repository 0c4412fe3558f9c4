// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/rosbags/replay_trajectories.h"

#include <algorithm>
#include <map>

namespace planecloud {
namespace {

void sortByStamp(Trajectory& trajectory) {
  std::stable_sort(trajectory.begin(), trajectory.end(),
                   [](const StampedPose& a, const StampedPose& b) { return a.stamp < b.stamp; });
}

double pathLength(const std::vector<FrameResult>& frames) {
  double length = 0.0;
  const FrameResult* previous = nullptr;
  for (const FrameResult& frame : frames) {
    if (frame.status == TrackingStatus::kLost) continue;
    // How far a robot went between two segments is not known.
    if (previous != nullptr && frame.status == TrackingStatus::kTracked) {
      length += (frame.T_odom_camera.translation() - previous->T_odom_camera.translation()).norm();
    }
    previous = &frame;
  }
  return length;
}

}  // namespace

RobotTrajectories extractTrajectories(const RobotLog& log, const MapSnapshot& map) {
  RobotTrajectories trajectories;
  std::map<KeyframeId, Eigen::Isometry3d> references;
  for (const MapSnapshot::Node& node : map.nodes) {
    if (node.keyframe->id.robot != log.robot) continue;
    references[node.keyframe->id] = node.T_map_camera;
    trajectories.keyframes.push_back({node.keyframe->stamp, node.T_map_camera});
  }
  for (const FrameResult& frame : log.frames) {
    if (frame.status == TrackingStatus::kLost) continue;
    trajectories.odometry.push_back({frame.stamp, frame.T_odom_camera});
    const auto reference = references.find(frame.reference);
    if (reference == references.end()) continue;
    trajectories.frames.push_back({frame.stamp, reference->second * frame.T_reference_camera});
  }
  sortByStamp(trajectories.frames);
  sortByStamp(trajectories.keyframes);
  sortByStamp(trajectories.odometry);
  trajectories.path_length = pathLength(log.frames);
  return trajectories;
}

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/rosbags/replay_output.h"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>

#include "planecloud_slam/backend_node/map_export.h"
#include "planecloud_slam/rosbags/map_picture.h"
#include "planecloud_slam/rosbags/trajectory_file.h"

namespace planecloud {
namespace {

/// `trajectory` moved by `T`.
Trajectory moved(const Eigen::Isometry3d& T, const Trajectory& trajectory) {
  Trajectory result;
  for (const StampedPose& pose : trajectory) result.push_back({pose.stamp, T * pose.pose});
  return result;
}

/// The poses of `trajectory` between the first and the last stamp of `other`.
Trajectory during(const Trajectory& other, const Trajectory& trajectory) {
  Trajectory result;
  for (const StampedPose& pose : trajectory) {
    if (other.empty() || pose.stamp < other.front().stamp || pose.stamp > other.back().stamp) {
      continue;
    }
    result.push_back(pose);
  }
  return result;
}

/// Odometry and ground truth in the frame of the map: odometry begins where the optimised way does.
PictureRobot makePictureRobot(const JudgedReplay& replay, std::size_t index) {
  const RobotTrajectories& ways = replay.trajectories[index];
  PictureRobot robot;
  robot.name = replay.result.robots[index].robot;
  robot.optimised = ways.frames;
  if (!ways.frames.empty()) {
    const Eigen::Isometry3d T_map_odom =
        ways.frames.front().pose * ways.odometry.front().pose.inverse();
    robot.odometry = moved(T_map_odom, ways.odometry);
  }
  if (replay.judgement) {
    robot.ground_truth = moved(replay.judgement->T_world_map.inverse(),
                               during(ways.odometry, replay.result.robots[index].ground_truth));
  }
  return robot;
}

std::string makeSubtitle(const JudgedReplay& replay) {
  std::size_t planes = 0;
  for (const MapSnapshot::Node& node : replay.result.map->nodes) {
    planes += node.keyframe->planes.count();
  }
  double bytes = 0.0;
  double path = 0.0;
  for (std::size_t i = 0; i < replay.result.robots.size(); ++i) {
    for (const double size : replay.result.robots[i].keyframe_bytes) bytes += size;
    path += replay.trajectories[i].path_length;
  }
  char text[256];
  std::snprintf(text, sizeof(text),
                "%.1f m of path   |   %zu keyframes   |   %zu planes   |   "
                "%.0f KB in all",
                path, replay.result.map->nodes.size(), planes, 1e-3 * bytes);
  std::string subtitle = text;
  if (replay.judgement) {
    std::snprintf(text, sizeof(text), "   |   ATE %.1f cm, odometry alone %.1f cm",
                  1e2 * replay.judgement->ate_rmse, 1e2 * replay.judgement->odometry_ate_rmse);
    subtitle += text;
  }
  return subtitle;
}

MapPicture makePicture(const JudgedReplay& replay) {
  MapPicture picture;
  picture.title = "Plane map from above";
  picture.subtitle = makeSubtitle(replay);
  for (std::size_t i = 0; i < replay.trajectories.size(); ++i) {
    picture.robots.push_back(makePictureRobot(replay, i));
  }
  if (replay.judgement) {
    picture.T_view_map = replay.judgement->T_world_map;
    picture.closures = replay.judgement->closures.closures;
    return picture;
  }
  for (const GraphEdge& edge : replay.result.map->edges) {
    if (edge.kind == EdgeKind::kClosure) {
      picture.closures.push_back({edge, ClosureTruth::kUnknown});
    }
  }
  return picture;
}

void writeTrajectories(const std::string& folder, const JudgedReplay& replay) {
  for (std::size_t i = 0; i < replay.trajectories.size(); ++i) {
    const RobotLog& log = replay.result.robots[i];
    const std::string prefix = folder + "/" + log.robot;
    writeTrajectory(prefix + "_frames.txt", replay.trajectories[i].frames);
    writeTrajectory(prefix + "_keyframes.txt", replay.trajectories[i].keyframes);
    writeTrajectory(prefix + "_odometry.txt", replay.trajectories[i].odometry);
    if (!log.ground_truth.empty()) writeTrajectory(prefix + "_groundtruth.txt", log.ground_truth);
  }
}

}  // namespace

void writeReplay(const std::string& folder, const JudgedReplay& replay) {
  std::filesystem::create_directories(folder);
  writeTrajectories(folder, replay);
  const std::string picture = folder + "/map.png";
  if (!cv::imwrite(picture, drawMap(*replay.result.map, makePicture(replay)))) {
    throw std::runtime_error("cannot write '" + picture + "'");
  }
  writePlaneMap(folder + "/map.ply", *replay.result.map);
  std::ofstream report(folder + "/report.json");
  report << makeReport(replay).dump(2) << '\n';
  report.close();
  if (!report) throw std::runtime_error("cannot write '" + folder + "/report.json'");
}

}  // namespace planecloud

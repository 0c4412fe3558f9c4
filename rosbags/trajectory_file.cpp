// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/rosbags/trajectory_file.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace planecloud {
namespace {

// Benchmarks print four decimals, so a norm may be off by some 1e-4; more is another format.
constexpr double kUnitTolerance = 0.01;

[[noreturn]] void refuseLine(const std::string& path, int number, const std::string& cause) {
  throw std::runtime_error(path + ":" + std::to_string(number) + ": " + cause +
                           "; expected 'stamp tx ty tz qx qy qz qw' (s, m, unit quaternion)");
}

StampedPose parseLine(const std::string& path, int number, const std::string& line) {
  std::istringstream words(line);
  double values[8];
  for (double& value : values) {
    if (!(words >> value)) refuseLine(path, number, "fewer than 8 numbers in '" + line + "'");
    if (!std::isfinite(value)) refuseLine(path, number, "a number that is not finite");
  }
  std::string rest;
  if (words >> rest) refuseLine(path, number, "unexpected '" + rest + "' after 8 numbers");
  const Eigen::Quaterniond q(values[7], values[4], values[5], values[6]);
  if (std::abs(q.norm() - 1.0) > kUnitTolerance) {
    refuseLine(path, number, "quaternion of norm " + std::to_string(q.norm()));
  }
  StampedPose pose;
  pose.stamp = values[0];
  pose.pose.linear() = q.normalized().toRotationMatrix();
  pose.pose.translation() = Eigen::Vector3d(values[1], values[2], values[3]);
  return pose;
}

}  // namespace

Trajectory readTrajectory(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error("cannot read trajectory '" + path + "'");
  Trajectory trajectory;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    const std::size_t first = line.find_first_not_of(" \t\r");
    if (first == std::string::npos || line[first] == '#') continue;
    trajectory.push_back(parseLine(path, number, line));
  }
  std::stable_sort(trajectory.begin(), trajectory.end(),
                   [](const StampedPose& a, const StampedPose& b) { return a.stamp < b.stamp; });
  return trajectory;
}

void writeTrajectory(const std::string& path, const Trajectory& trajectory) {
  std::ofstream file(path);
  file << "# stamp tx ty tz qx qy qz qw\n";
  for (const StampedPose& entry : trajectory) {
    const Eigen::Vector3d& t = entry.pose.translation();
    Eigen::Quaterniond q(entry.pose.linear());
    if (q.w() < 0.0) q.coeffs() = -q.coeffs();
    char line[256];
    std::snprintf(line, sizeof(line), "%.6f %.6f %.6f %.6f %.7f %.7f %.7f %.7f\n", entry.stamp,
                  t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w());
    file << line;
  }
  file.close();
  if (!file) throw std::runtime_error("cannot write trajectory '" + path + "'");
}

}  // namespace planecloud

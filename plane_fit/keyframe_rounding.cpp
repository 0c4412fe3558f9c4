// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/plane_fit/keyframe_rounding.h"

#include <algorithm>
#include <cmath>

namespace planecloud {
namespace {

constexpr double kCoverageStep = 1e-4;  // [-]
constexpr double kErrorStep = 1e-5;     // [m]
constexpr double kTimeStep = 1e-4;      // [s]
constexpr double kMaxSteps = 65535.0;
constexpr double kMaxCoverageSteps = 10000.0;

double roundToSingle(double value) { return static_cast<double>(static_cast<float>(value)); }

std::uint16_t countSteps(double value, double step, double max_steps) {
  const double steps = std::round(value / step);
  if (!(steps > 0.0)) return 0;
  return static_cast<std::uint16_t>(std::min(steps, max_steps));
}

PlaneCloudStatistics roundStatistics(const PlaneCloudStatistics& statistics) {
  PlaneCloudStatistics rounded = unpackStatistics(packStatistics(statistics));
  rounded.stopped_by_time = statistics.stopped_by_time;
  rounded.stopped_by_bytes = statistics.stopped_by_bytes;
  return rounded;
}

}  // namespace

PackedPose packPose(const Eigen::Isometry3d& T) {
  const Eigen::Vector3f t = T.translation().cast<float>();
  const Eigen::Vector3f phi = logSo3(Eigen::Quaterniond(T.linear()).normalized()).cast<float>();
  return {t.x(), t.y(), t.z(), phi.x(), phi.y(), phi.z()};
}

Eigen::Isometry3d unpackPose(const PackedPose& packed) {
  const Eigen::Vector3f phi(packed[3], packed[4], packed[5]);
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = expSo3(phi.cast<double>()).toRotationMatrix();
  T.translation() = Eigen::Vector3f(packed[0], packed[1], packed[2]).cast<double>();
  return T;
}

PackedInformation packInformation(const Matrix6d& information) {
  PackedInformation packed;
  std::size_t next = 0;
  for (int row = 0; row < 6; ++row) {
    for (int column = row; column < 6; ++column) {
      packed[next++] = static_cast<float>(information(row, column));
    }
  }
  return packed;
}

Matrix6d unpackInformation(const PackedInformation& packed) {
  Matrix6d information;
  std::size_t next = 0;
  for (int row = 0; row < 6; ++row) {
    for (int column = row; column < 6; ++column) {
      information(row, column) = information(column, row) = static_cast<double>(packed[next++]);
    }
  }
  return information;
}

PackedStatistics packStatistics(const PlaneCloudStatistics& statistics) {
  return {countSteps(statistics.coverage, kCoverageStep, kMaxCoverageSteps),
          countSteps(statistics.point_plane_error, kErrorStep, kMaxSteps),
          countSteps(statistics.depth_error, kErrorStep, kMaxSteps),
          countSteps(statistics.fit_time, kTimeStep, kMaxSteps)};
}

PlaneCloudStatistics unpackStatistics(const PackedStatistics& packed) {
  PlaneCloudStatistics statistics;
  statistics.coverage = kCoverageStep * packed.coverage;
  statistics.point_plane_error = kErrorStep * packed.point_plane_error;
  statistics.depth_error = kErrorStep * packed.depth_error;
  statistics.fit_time = kTimeStep * packed.fit_time;
  return statistics;
}

CameraIntrinsics roundCamera(CameraIntrinsics camera) {
  for (double* value : {&camera.fx, &camera.fy, &camera.cx, &camera.cy}) {
    *value = roundToSingle(*value);
  }
  for (double& coefficient : camera.distortion) coefficient = roundToSingle(coefficient);
  return camera;
}

double roundStamp(double stamp) {
  const double seconds = std::floor(stamp);
  return seconds + 1e-9 * std::round((stamp - seconds) * 1e9);
}

Keyframe asTravelled(Keyframe keyframe) {
  keyframe.stamp = roundStamp(keyframe.stamp);
  keyframe.T_odom_camera = unpackPose(packPose(keyframe.T_odom_camera));
  keyframe.planes.camera = roundCamera(keyframe.planes.camera);
  keyframe.planes.statistics = roundStatistics(keyframe.planes.statistics);
  for (RelativePoseEdge& edge : keyframe.edges) {
    edge.T_other_this = unpackPose(packPose(edge.T_other_this));
    edge.information = unpackInformation(packInformation(edge.information));
  }
  return keyframe;
}

}  // namespace planecloud

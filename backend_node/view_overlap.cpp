// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/backend_node/view_overlap.h"

#include <algorithm>

namespace planecloud {
namespace {

constexpr double kNearestDepth = 0.1;  ///< of a point in the other's view [m]

double viewShare(const ViewSketch& target, const ViewSketch& source,
                 const Eigen::Isometry3d& T_target_source) {
  if (source.samples.empty()) return 0.0;
  const CameraIntrinsics& into = target.camera;
  int seen = 0;
  for (const ViewSketch::Sample& sample : source.samples) {
    const Eigen::Vector3d point = T_target_source * sample.point.cast<double>();
    if (point.z() < kNearestDepth) continue;
    const Eigen::Vector3d normal = T_target_source.linear() * sample.normal.cast<double>();
    if (normal.dot(point) >= 0.0) continue;
    const double x = into.fx * point.x() / point.z() + into.cx;
    const double y = into.fy * point.y() / point.z() + into.cy;
    if (x >= 0.0 && x < into.width && y >= 0.0 && y < into.height) ++seen;
  }
  return seen / static_cast<double>(source.samples.size());
}

}  // namespace

double mutualViewOverlap(const ViewSketch& target, const ViewSketch& source,
                         const Eigen::Isometry3d& T_target_source) {
  return std::min(viewShare(target, source, T_target_source),
                  viewShare(source, target, T_target_source.inverse()));
}

}  // namespace planecloud

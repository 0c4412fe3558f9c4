// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/backend_node/view_overlap.h"

#include <algorithm>

namespace planecloud {
namespace {

constexpr double kNearestDepth = 0.1;  ///< of a point in the other's view [m]

double viewShare(const PlaneCloud& target, const PlaneCloud& source,
                 const Eigen::Isometry3d& T_target_source) {
  const CameraIntrinsics& from = source.camera;
  const CameraIntrinsics& into = target.camera;
  double total = 0.0;
  double seen = 0.0;
  for (const PlanarTile& tile : source.tiles) {
    const double u = (tile.rect.x + 0.5 * tile.rect.width - from.cx) / from.fx;
    const double v = (tile.rect.y + 0.5 * tile.rect.height - from.cy) / from.fy;
    const double q = tile.inverse_depth.cast<double>().dot(Eigen::Vector3d(u, v, 1.0));
    const double area = tile.rect.area();
    total += area;
    if (q <= 0.0) continue;
    const Eigen::Vector3d point = T_target_source * Eigen::Vector3d(u / q, v / q, 1.0 / q);
    if (point.z() < kNearestDepth) continue;
    const Eigen::Vector3d normal = T_target_source.linear() * -tile.inverse_depth.cast<double>();
    if (normal.dot(point) >= 0.0) continue;
    const double x = into.fx * point.x() / point.z() + into.cx;
    const double y = into.fy * point.y() / point.z() + into.cy;
    if (x >= 0.0 && x < into.width && y >= 0.0 && y < into.height) seen += area;
  }
  return total > 0.0 ? seen / total : 0.0;
}

}  // namespace

double mutualViewOverlap(const PlaneCloud& target, const PlaneCloud& source,
                         const Eigen::Isometry3d& T_target_source) {
  return std::min(viewShare(target, source, T_target_source),
                  viewShare(source, target, T_target_source.inverse()));
}

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/icap/visibility.h"

#include <algorithm>
#include <cmath>

namespace planecloud {
namespace {

constexpr double kRightAngle = 1.5707963267948966;

double share(double part, double whole) { return whole > 0.0 ? part / whole : 0.0; }

/// Of normals that count as the same: noisy ones get the room they need.
double leastCosine(const PlanePatch& a, const PlanePatch& b, const VisibilityOptions& options) {
  const double noise = 2.0 * std::hypot(a.normal_sigma, b.normal_sigma);
  return std::cos(std::min(options.normal_tolerance + noise, kRightAngle));
}

/// Files one source piece, already in the target's frame, under what the target says of it.
void judge(const PlaneSet& target, const PlanePatch& moved, const VisibilityOptions& options,
           VisibilityReport& report) {
  const double weight = moved.rect.area();
  report.total += weight;
  if (moved.centroid.z() <= 0.0 || moved.normal.dot(moved.centroid) >= 0.0) return;
  const Eigen::Vector2d pixel = target.project(moved.centroid);
  const CameraIntrinsics& k = target.camera();
  if (!(pixel.x() > -0.5 && pixel.y() > -0.5 && pixel.x() < k.width - 0.5 &&
        pixel.y() < k.height - 0.5)) {
    return;
  }
  report.in_view += weight;
  const int tile = target.patchAt(static_cast<int>(std::lround(pixel.x())),
                                  static_cast<int>(std::lround(pixel.y())));
  if (tile < 0) {
    report.unknown += weight;
    return;
  }
  const PlanePatch& seen = target.patches(PlaneSet::Level::kWhole)[static_cast<std::size_t>(tile)];
  const double z = moved.centroid.z();
  // Where the piece's own ray meets the target's plane; a grazing plane is met anywhere.
  const double slope = -seen.normal.dot(moved.centroid) / z;
  const double seen_z = slope > 0.0 ? seen.d / slope : z;
  const double tolerance = options.depth_tolerance + options.depth_tolerance_z2 * z * z;
  if (z - seen_z > tolerance) {
    report.occluded += weight;
  } else if (seen_z - z > tolerance) {
    report.seen_through += weight;
  } else if (moved.normal.dot(seen.normal) > leastCosine(moved, seen, options)) {
    report.agreeing += weight;
  } else {
    report.differing += weight;
  }
}

}  // namespace

double VisibilityReport::overlap() const {
  return share(agreeing, agreeing + differing + seen_through);
}

double VisibilityReport::seenThroughShare() const {
  return share(seen_through, agreeing + differing + seen_through + occluded);
}

double VisibilityReport::viewShare() const { return share(in_view, total); }

VisibilityReport checkVisibility(const PlaneSet& target, const PlaneSet& source,
                                 const Eigen::Isometry3d& T_target_source,
                                 const VisibilityOptions& options) {
  options.check();
  VisibilityReport report;
  for (PlanePatch patch : source.patches(PlaneSet::Level::kCoarse)) {
    patch.centroid = T_target_source * patch.centroid;
    patch.normal = T_target_source.linear() * patch.normal;
    judge(target, patch, options, report);
  }
  return report;
}

}  // namespace planecloud

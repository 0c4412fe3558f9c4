// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/icap/visibility.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace planecloud {
namespace {

constexpr double kRightAngle = 1.5707963267948966;

double share(double part, double whole) { return whole > 0.0 ? part / whole : 0.0; }

/// What every piece is judged by.
struct Judge {
  const PlaneSet& target;
  const std::vector<PlanePatch>& tiles;
  VisibilityOptions options;
  double least_cosine;  ///< of normals that count as the same whatever their noise
};

/// Whether the normals may be the same: noisy ones get the room they need.
bool sameNormal(const PlanePatch& a, const PlanePatch& b, double cosine, const Judge& judge) {
  if (cosine > judge.least_cosine) return true;
  const double noise =
      2.0 * std::sqrt(a.normal_sigma * a.normal_sigma + b.normal_sigma * b.normal_sigma);
  return cosine > std::cos(std::min(judge.options.normal_tolerance + noise, kRightAngle));
}

/// Files a source piece, moved into the target's frame, under what the target says of it.
void file(const Judge& judge, const PlanePatch& piece, const Eigen::Isometry3d& T_target_source,
          VisibilityReport& report) {
  const double weight = piece.rect.area();
  report.total += weight;
  const Eigen::Vector3d centroid = T_target_source * piece.centroid;
  const Eigen::Vector3d normal = T_target_source.linear() * piece.normal;
  if (centroid.z() <= 0.0 || normal.dot(centroid) >= 0.0) return;
  const Eigen::Vector2d pixel = judge.target.project(centroid);
  const CameraIntrinsics& k = judge.target.camera();
  if (!(pixel.x() > -0.5 && pixel.y() > -0.5 && pixel.x() < k.width - 0.5 &&
        pixel.y() < k.height - 0.5)) {
    return;
  }
  report.in_view += weight;
  const int tile =
      judge.target.patchAt(static_cast<int>(pixel.x() + 0.5), static_cast<int>(pixel.y() + 0.5));
  if (tile < 0) {
    report.unknown += weight;
    return;
  }
  const PlanePatch& seen = judge.tiles[static_cast<std::size_t>(tile)];
  const double z = centroid.z();
  // Where the piece's own ray meets the target's plane; a grazing plane is met anywhere.
  const double slope = -seen.normal.dot(centroid) / z;
  const double seen_z = slope > 0.0 ? seen.d / slope : z;
  const double tolerance = judge.options.depth_tolerance + judge.options.depth_tolerance_z2 * z * z;
  if (z - seen_z > tolerance) {
    report.occluded += weight;
  } else if (seen_z - z > tolerance) {
    report.seen_through += weight;
  } else if (sameNormal(piece, seen, normal.dot(seen.normal), judge)) {
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
  const Judge judge{target, target.patches(PlaneSet::Level::kWhole), options,
                    std::cos(std::min(options.normal_tolerance, kRightAngle))};
  VisibilityReport report;
  for (const PlanePatch& piece : source.patches(PlaneSet::Level::kFine)) {
    file(judge, piece, T_target_source, report);
  }
  return report;
}

}  // namespace planecloud

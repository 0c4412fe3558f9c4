// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/icap/visibility.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace planecloud {
namespace {

constexpr double kRightAngle = 1.5707963267948966;

double share(double part, double whole) { return whole > 0.0 ? part / whole : 0.0; }

/// What every piece is judged by.
struct Judge {
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

/// Files a source piece under what the target says of it, entry `i` of `seen`.
void file(const Judge& judge, const PlanePatch& piece, const SeenTiles& seen, std::size_t i,
          VisibilityReport& report) {
  const double weight = piece.rect.area();
  report.total += weight;
  if (seen.tiles[i] == SeenTiles::kNotInView) return;
  report.in_view += weight;
  if (seen.tiles[i] == SeenTiles::kNoTile) {
    report.unknown += weight;
    return;
  }
  const double z = seen.depth[i];
  const double behind = z - static_cast<double>(seen.seen_depth[i]);
  const double tolerance = judge.options.depth_tolerance + judge.options.depth_tolerance_z2 * z * z;
  if (behind > tolerance) {
    report.occluded += weight;
  } else if (-behind > tolerance) {
    report.seen_through += weight;
  } else if (sameNormal(piece, judge.tiles[static_cast<std::size_t>(seen.tiles[i])], seen.cosine[i],
                        judge)) {
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
  const Judge judge{target.patches(PlaneSet::Level::kWhole), options,
                    std::cos(std::min(options.normal_tolerance, kRightAngle))};
  const std::vector<PlanePatch>& pieces = source.patches(PlaneSet::Level::kFine);
  const SeenTiles seen =
      target.empty()
          ? SeenTiles(pieces.size())
          : lookUpTiles(target.view(), {source.fineColumns(), pieces.size(), T_target_source});
  VisibilityReport report;
  for (std::size_t i = 0; i < pieces.size(); ++i) file(judge, pieces[i], seen, i, report);
  return report;
}

}  // namespace planecloud

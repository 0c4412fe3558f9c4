// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/icap/patch_matcher.h"

#include <algorithm>
#include <cmath>

#include "planecloud_slam/icap/kd_tree.h"

namespace planecloud {
namespace {

// The tree knows distances between centroids, the cost forgives what lies within the radii: so ask
// for a few neighbours and choose among them.
constexpr std::size_t kCandidates = 4;

struct Candidate {
  double surface_squared = 0.0;  // plane distance and gap [m^2]
  double normal_squared = 0.0;   // |dn|^2
};

Candidate compare(const PlanePatch& target, const PlanePatch& source, const Eigen::Vector3d& c,
                  const Eigen::Vector3d& n) {
  const Eigen::Vector3d offset = c - target.centroid;
  const double distance = target.normal.dot(offset);
  const double in_plane = std::sqrt(std::max(0.0, offset.squaredNorm() - distance * distance));
  const double gap = std::max(0.0, in_plane - target.radius - source.radius);
  return {distance * distance + gap * gap, (n - target.normal).squaredNorm()};
}

}  // namespace

PatchMatcher::PatchMatcher(const PlaneSet& target, const PlaneSet& source, PlaneSet::Level level,
                           int max_patches)
    : target_(target),
      source_(source),
      level_(level),
      source_count_(std::min(source.patches(level).size(), static_cast<std::size_t>(max_patches))) {
}

std::vector<PatchMatch> PatchMatcher::match(const Eigen::Isometry3d& T_target_source,
                                            const MatchGates& gates) const {
  const std::vector<PlanePatch>& targets = target_.patches(level_);
  const KdTree<6>& index = target_.index(level_);
  const double normal_length_squared = target_.normalLength() * target_.normalLength();
  const double max_surface = gates.distance * gates.distance;
  const double max_normal = 2.0 - 2.0 * std::cos(gates.angle);
  std::vector<PatchMatch> matches;
  matches.reserve(source_count_);
  for (std::size_t i = 0; i < source_count_; ++i) {
    const PlanePatch& source = source_.patches(level_)[i];
    const Eigen::Vector3d c = T_target_source * source.centroid;
    const Eigen::Vector3d n = T_target_source.linear() * source.normal;
    const auto [neighbours, found] = index.nearest<kCandidates>(target_.matchingPoint(c, n));
    double best_cost = 1e9;
    const PlanePatch* best = nullptr;
    for (std::size_t k = 0; k < found; ++k) {
      const PlanePatch& target = targets[neighbours[k]];
      const Candidate candidate = compare(target, source, c, n);
      if (candidate.surface_squared > max_surface || candidate.normal_squared > max_normal)
        continue;
      const double cost =
          candidate.surface_squared + normal_length_squared * candidate.normal_squared;
      if (cost < best_cost) {
        best_cost = cost;
        best = &target;
      }
    }
    if (best != nullptr) matches.push_back({best, &source});
  }
  return matches;
}

}  // namespace planecloud

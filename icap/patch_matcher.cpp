// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/icap/patch_matcher.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace planecloud {
namespace {

constexpr double kNearestDepth = 0.1;    // of a patch in the target's view [m]
constexpr double kShortestStride = 4.0;  // to the neighbours asked, cf. the map's cells [px]
constexpr double kLongestStride = 32.0;  // [px]
constexpr double kStrideOfGate = 0.5;    // the stride as a share of the gate

/// The patch a ray falls upon and its four neighbours.
constexpr std::array<std::array<double, 2>, 5> kOffsets{
    {{0.0, 0.0}, {1.0, 0.0}, {-1.0, 0.0}, {0.0, 1.0}, {0.0, -1.0}}};

/// A source patch where the guess puts it.
struct Moved {
  Eigen::Vector3d centroid;
  Eigen::Vector3d normal;
};

double minCosine(const MatchGates& gates) { return std::cos(gates.angle); }

/// Finds the best target tile for `moved` around where it falls in the image.
const PlanePatch* bestInView(const PlaneSet& target, const Moved& moved, const MatchGates& gates,
                             double least_cosine) {
  const Eigen::Vector2d pixel = target.project(moved.centroid);
  const double pixel_size = moved.centroid.z() / target.camera().fx;
  const double stride =
      std::clamp(kStrideOfGate * gates.distance / pixel_size, kShortestStride, kLongestStride);
  const double squared_length = gates.normal_length * gates.normal_length;
  const PlanePatch* best = nullptr;
  double best_cost = 1e9;
  for (const auto& [dx, dy] : kOffsets) {
    const int tile = target.patchAt(static_cast<int>(std::floor(pixel.x() + stride * dx + 0.5)),
                                    static_cast<int>(std::floor(pixel.y() + stride * dy + 0.5)));
    if (tile < 0) continue;
    const PlanePatch& seen =
        target.patches(PlaneSet::Level::kWhole)[static_cast<std::size_t>(tile)];
    const double cosine = seen.normal.dot(moved.normal);
    const double distance = seen.normal.dot(moved.centroid) + seen.d;
    if (&seen == best || cosine < least_cosine || std::abs(distance) > gates.distance) continue;
    const double gap = dx == 0.0 && dy == 0.0 ? 0.0 : stride * pixel_size;
    const double cost = distance * distance + gap * gap + squared_length * (2.0 - 2.0 * cosine);
    if (cost >= best_cost) continue;
    best_cost = cost;
    best = &seen;
  }
  return best;
}

}  // namespace

std::vector<PatchMatch> matchAnywhere(const PlaneSet& target, const PlaneSet& source,
                                      const Eigen::Isometry3d& T_target_source,
                                      const MatchGates& gates, std::size_t count) {
  const std::vector<PlanePatch>& targets = target.patches(PlaneSet::Level::kCoarse);
  const std::vector<PlanePatch>& sources = source.patches(PlaneSet::Level::kCoarse);
  PatchQuery query;
  query.max_squared_distance = static_cast<float>(gates.distance * gates.distance);
  query.min_cosine = static_cast<float>(minCosine(gates));
  query.squared_normal_length = static_cast<float>(gates.normal_length * gates.normal_length);
  std::vector<PatchMatch> matches;
  matches.reserve(std::min(count, sources.size()));
  for (std::size_t i = 0; i < std::min(count, sources.size()); ++i) {
    query.centroid = (T_target_source * sources[i].centroid).cast<float>();
    query.normal = (T_target_source.linear() * sources[i].normal).cast<float>();
    query.radius = static_cast<float>(sources[i].radius);
    const int nearest = nearestPatch(target.coarseColumns(), query);
    if (nearest >= 0) matches.push_back({&targets[static_cast<std::size_t>(nearest)], &sources[i]});
  }
  return matches;
}

std::vector<PatchMatch> matchInView(const PlaneSet& target, const PlaneSet& source,
                                    const Eigen::Isometry3d& T_target_source,
                                    const MatchGates& gates, std::size_t count) {
  const std::vector<PlanePatch>& sources = source.patches(PlaneSet::Level::kFine);
  const std::size_t tried = std::min(count, sources.size());
  std::vector<PatchMatch> matches;
  matches.reserve(tried);
  const double least_cosine = minCosine(gates);
  for (std::size_t i = 0; i < tried; ++i) {
    const PlanePatch& patch = sources[i];
    const Moved moved{T_target_source * patch.centroid, T_target_source.linear() * patch.normal};
    if (moved.centroid.z() < kNearestDepth || moved.normal.dot(moved.centroid) >= 0.0) continue;
    const PlanePatch* best = bestInView(target, moved, gates, least_cosine);
    if (best != nullptr) matches.push_back({best, &patch});
  }
  return matches;
}

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/icap/patch_matcher.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace planecloud {
namespace {

double minCosine(const MatchGates& gates) { return std::cos(gates.angle); }

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
  if (target.empty()) return {};
  const std::vector<PlanePatch>& tiles = target.patches(PlaneSet::Level::kWhole);
  const std::vector<PlanePatch>& sources = source.patches(PlaneSet::Level::kFine);
  ViewGates view_gates;
  view_gates.distance = static_cast<float>(gates.distance);
  view_gates.min_cosine = static_cast<float>(minCosine(gates));
  view_gates.squared_normal_length = static_cast<float>(gates.normal_length * gates.normal_length);
  const std::vector<std::int32_t> found = bestTiles(
      target.view(), {source.fineColumns(), std::min(count, sources.size()), T_target_source},
      view_gates);
  std::vector<PatchMatch> matches;
  matches.reserve(found.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (found[i] < 0) continue;
    matches.push_back({&tiles[static_cast<std::size_t>(found[i])], &sources[i]});
  }
  return matches;
}

}  // namespace planecloud

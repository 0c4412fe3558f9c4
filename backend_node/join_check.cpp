// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/backend_node/join_check.h"

#include <algorithm>

#include "planecloud_slam/backend_node/view_overlap.h"
#include "planecloud_slam/icap/visibility.h"

namespace planecloud {
namespace {

constexpr double kLargestPairDistance = 2.0;  ///< of the cameras of a pair [m]
constexpr double kLeastOverlap = 0.3;         ///< predicted, of the views of a pair
constexpr std::size_t kMostPairs = 12;        ///< looked at, spread over all there are

/// Nodes within `path` [m] of an end of one of the closures.
std::vector<bool> nodesNear(const PoseGraph& graph, const std::vector<GraphEdge>& closures,
                            double path) {
  std::vector<bool> near(static_cast<std::size_t>(graph.size()), false);
  for (const GraphEdge& closure : closures) {
    for (const KeyframeId& end : {closure.from, closure.to}) {
      const std::vector<double> lengths = graph.pathLengths(graph.find(end).value(), path);
      for (std::size_t i = 0; i < near.size(); ++i) near[i] = near[i] || lengths[i] <= path;
    }
  }
  return near;
}

/// Those of a component that are `near`.
std::vector<int> chosen(const PoseGraph& graph, int component, const std::vector<bool>& near) {
  std::vector<int> nodes;
  for (const int node : graph.members(component)) {
    if (near[static_cast<std::size_t>(node)]) nodes.push_back(node);
  }
  return nodes;
}

}  // namespace

std::vector<JoinCheck::Pair> JoinCheck::overlappingPairs(const PoseGraph& graph,
                                                         const KeyframeRecords& records,
                                                         const ComponentJoin& join,
                                                         const std::vector<bool>& near) const {
  const std::vector<int> targets = chosen(graph, join.target, near);
  std::vector<Pair> pairs;
  for (const int source : chosen(graph, join.source, near)) {
    Pair best;
    double best_overlap = kLeastOverlap;
    for (const int target : targets) {
      const Eigen::Isometry3d T_target_source =
          graph.pose(target).inverse() * join.T_target_source * graph.pose(source);
      if (T_target_source.translation().norm() > kLargestPairDistance) continue;
      const double overlap =
          mutualViewOverlap(records[static_cast<std::size_t>(target)].sketch,
                            records[static_cast<std::size_t>(source)].sketch, T_target_source);
      if (overlap <= best_overlap) continue;
      best_overlap = overlap;
      best = {target, source, T_target_source};
    }
    if (best_overlap > kLeastOverlap) pairs.push_back(best);
  }
  return pairs;
}

double JoinCheck::seenThrough(const PlaneSet& target, const PlaneSet& source,
                              const Eigen::Isometry3d& T_target_source_guess) const {
  // Odometry's drift between the pair and the closures alone would let surfaces seen at a grazing
  // angle stand out, so the pair is aligned first; but from where the join puts it.
  IcapOptions options = icap_;
  options.restarts = false;
  const IcapResult alignment = icap(target, source, T_target_source_guess, options);
  const Eigen::Isometry3d& T_target_source = alignment.T_target_source;
  const VisibilityReport forth = checkVisibility(target, source, T_target_source, icap_.visibility);
  const VisibilityReport back =
      checkVisibility(source, target, T_target_source.inverse(), icap_.visibility);
  return std::max(forth.seenThroughShare(), back.seenThroughShare());
}

std::vector<JoinCheck::Pair> JoinCheck::spread(const std::vector<Pair>& pairs) {
  if (pairs.size() <= kMostPairs) return pairs;
  std::vector<Pair> some;
  for (std::size_t i = 0; i < kMostPairs; ++i) {
    some.push_back(pairs[i * (pairs.size() - 1) / (kMostPairs - 1)]);
  }
  return some;
}

bool JoinCheck::holds(const PoseGraph& graph, const KeyframeRecords& records,
                      const ComponentJoin& join, const std::vector<GraphEdge>& closures,
                      PlaneSetCache& plane_sets) const {
  const std::vector<bool> near = nodesNear(graph, closures, options_.join_check_path);
  const std::vector<Pair> pairs = spread(overlappingPairs(graph, records, join, near));
  const double limit = options_.join_seen_through * static_cast<double>(pairs.size());
  double sum = 0.0;
  for (const Pair& pair : pairs) {
    // Shares are no less than zero: once over the limit, no other pair can mend it.
    if (sum > limit) return false;
    sum += seenThrough(plane_sets.get(records, pair.target), plane_sets.get(records, pair.source),
                       pair.T_target_source);
  }
  return sum <= limit;
}

}  // namespace planecloud

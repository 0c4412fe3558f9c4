// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/backend_node/loop_closure_detector.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "planecloud_slam/backend_node/drift_model.h"
#include "planecloud_slam/backend_node/view_overlap.h"
#include "planecloud_slam/plane_fit/appearance_descriptor.h"

namespace planecloud {
namespace {

/// A candidate with what it is judged by: the smaller, the better.
using Scored = std::pair<double, LoopCandidate>;

const MapKeyframe& keyframe(const KeyframeRecords& records, int node) {
  return *records[static_cast<std::size_t>(node)].keyframe;
}

bool sameSession(const KeyframeId& a, const KeyframeId& b) {
  return a.session == b.session && a.robot == b.robot;
}

std::vector<LoopCandidate> best(std::vector<Scored> scored, int count) {
  std::stable_sort(scored.begin(), scored.end(),
                   [](const Scored& a, const Scored& b) { return a.first < b.first; });
  std::vector<LoopCandidate> candidates;
  for (const Scored& entry : scored) {
    if (static_cast<int>(candidates.size()) >= count) break;
    candidates.push_back(entry.second);
  }
  return candidates;
}

}  // namespace

std::vector<LoopCandidate> LoopClosureDetector::detect(const PoseGraph& graph,
                                                       const KeyframeRecords& records,
                                                       int source) const {
  const Query query{graph, records, source, graph.pathLengths(source)};
  std::vector<LoopCandidate> candidates = near(query);
  const std::vector<LoopCandidate> unlocated = alike(query);
  candidates.insert(candidates.end(), unlocated.begin(), unlocated.end());
  addHints(query, candidates);
  return candidates;
}

bool LoopClosureDetector::isRevisit(const Query& query, int target) const {
  if (target == query.source) return false;
  const KeyframeRecord& a = query.records[static_cast<std::size_t>(target)];
  const KeyframeRecord& b = query.records[static_cast<std::size_t>(query.source)];
  return !sameSession(a.keyframe->id, b.keyframe->id) ||
         std::abs(a.path - b.path) >= options_.min_path_gap;
}

std::vector<LoopCandidate> LoopClosureDetector::near(const Query& query) const {
  const PoseGraph& graph = query.graph;
  const Eigen::Isometry3d& T_map_source = graph.pose(query.source);
  std::vector<Scored> scored;
  for (int target = 0; target < graph.size(); ++target) {
    if (graph.component(target) != graph.component(query.source)) continue;
    if (!isRevisit(query, target)) continue;
    const double path = query.paths[static_cast<std::size_t>(target)];
    const double drift = drift_.translation_drift * std::min(path, 1e6);
    const double radius =
        std::min(options_.max_search_radius, options_.search_radius + 2.0 * drift);
    const Eigen::Isometry3d T_target_source = graph.pose(target).inverse() * T_map_source;
    const double distance = T_target_source.translation().norm();
    const double angle = std::acos(std::clamp(T_target_source.linear()(2, 2), -1.0, 1.0));
    if (distance > radius || angle > options_.max_view_angle) continue;
    const double overlap = mutualViewOverlap(
        query.records[static_cast<std::size_t>(target)].sketch,
        query.records[static_cast<std::size_t>(query.source)].sketch, T_target_source);
    if (overlap < options_.min_view_overlap) continue;
    scored.emplace_back(1.0 - overlap, LoopCandidate{target, query.source, true, path, 0.0});
  }
  return best(std::move(scored), options_.max_spatial);
}

std::vector<LoopCandidate> LoopClosureDetector::alike(const Query& query) const {
  const MapKeyframe& source = keyframe(query.records, query.source);
  std::vector<Scored> scored;
  for (int target = 0; target < query.graph.size(); ++target) {
    if (query.graph.component(target) == query.graph.component(query.source)) continue;
    const auto comparison = compareAppearance(keyframe(query.records, target).keyframe->descriptor,
                                              source.keyframe->descriptor);
    if (!comparison || comparison->dissimilarity > options_.max_dissimilarity) continue;
    const CameraIntrinsics& camera = source.planes.camera();
    const double turn = std::atan(comparison->shift_x * camera.width / camera.fx);
    scored.emplace_back(comparison->dissimilarity,
                        LoopCandidate{target, query.source, false, 0.0, turn});
  }
  return best(std::move(scored), options_.max_appearance);
}

void LoopClosureDetector::addHints(const Query& query,
                                   std::vector<LoopCandidate>& candidates) const {
  for (const KeyframeId& hint : keyframe(query.records, query.source).keyframe->closure_hints) {
    const std::optional<int> target = query.graph.find(hint);
    if (!target || *target == query.source) continue;
    const bool known =
        std::any_of(candidates.begin(), candidates.end(),
                    [&](const LoopCandidate& candidate) { return candidate.target == *target; });
    if (known) continue;
    const bool located = query.graph.component(*target) == query.graph.component(query.source);
    if (located && !isRevisit(query, *target)) continue;
    const double path = located ? query.paths[static_cast<std::size_t>(*target)] : 0.0;
    candidates.push_back({*target, query.source, located, path, 0.0});
  }
}

}  // namespace planecloud

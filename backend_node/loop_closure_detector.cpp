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

/// Keyframes whose descriptors are compared in full.
constexpr std::size_t kShortlist = 48;
/// A frontend gives a few; whoever gives more does not hold up the map.
constexpr int kMostHinted = 16;

const MapKeyframe& keyframe(const KeyframeRecords& records, int node) {
  return *records[static_cast<std::size_t>(node)].keyframe;
}

/// The first `count` of those that score lowest.
std::vector<LoopCandidate> best(std::vector<std::pair<double, LoopCandidate>> scored, int count) {
  std::stable_sort(scored.begin(), scored.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<LoopCandidate> candidates;
  for (const auto& [score, candidate] : scored) {
    if (static_cast<int>(candidates.size()) >= count) break;
    candidates.push_back(candidate);
  }
  return candidates;
}

}  // namespace

std::vector<LoopCandidate> LoopClosureDetector::detect(const PoseGraph& graph,
                                                       const KeyframeRecords& records, int source) {
  while (appearances_.size() < records.size()) {
    appearances_.add(keyframe(records, static_cast<int>(appearances_.size())).keyframe->descriptor);
  }
  const Query query{graph, records, source};
  std::vector<LoopCandidate> candidates = near(query);
  const std::vector<LoopCandidate> unlocated = alike(query);
  candidates.insert(candidates.end(), unlocated.begin(), unlocated.end());
  addHints(query, candidates);
  return candidates;
}

bool LoopClosureDetector::isRevisit(const Query& query, int target) const {
  if (target == query.source) return false;
  return planecloud::isRevisit(query.records[static_cast<std::size_t>(target)],
                               query.records[static_cast<std::size_t>(query.source)],
                               options_.min_path_gap);
}

std::optional<double> LoopClosureDetector::misfit(const Query& query, int target) const {
  const Eigen::Isometry3d T_target_source =
      query.graph.pose(target).inverse() * query.graph.pose(query.source);
  const double angle = std::acos(std::clamp(T_target_source.linear()(2, 2), -1.0, 1.0));
  if (T_target_source.translation().norm() > options_.max_search_radius) return std::nullopt;
  if (angle > options_.max_view_angle) return std::nullopt;
  const double overlap = mutualViewOverlap(
      query.records[static_cast<std::size_t>(target)].sketch,
      query.records[static_cast<std::size_t>(query.source)].sketch, T_target_source);
  if (overlap < options_.min_view_overlap) return std::nullopt;
  return 1.0 - overlap;
}

void LoopClosureDetector::measure(const Query& query, std::vector<Scored>& located) {
  std::vector<int> targets;
  for (const auto& [score, candidate] : located) targets.push_back(candidate.target);
  const std::vector<double> paths = query.graph.pathLengthsTo(query.source, targets);
  for (std::size_t i = 0; i < located.size(); ++i) located[i].second.path = paths[i];
}

std::vector<LoopCandidate> LoopClosureDetector::near(const Query& query) const {
  const PoseGraph& graph = query.graph;
  const int component = graph.component(query.source);
  std::vector<Scored> located;
  for (const int target : graph.nodesAround(query.source, options_.max_search_radius)) {
    if (graph.component(target) != component || !isRevisit(query, target)) continue;
    const std::optional<double> score = misfit(query, target);
    if (score) located.emplace_back(*score, LoopCandidate{target, query.source, true, 0.0, 0.0});
  }
  measure(query, located);
  std::vector<Scored> within;
  for (const Scored& entry : located) {
    const LoopCandidate& candidate = entry.second;
    const double drift = drift_.translation_drift * std::min(candidate.path, 1e6);
    const Eigen::Vector3d way =
        graph.pose(candidate.target).translation() - graph.pose(query.source).translation();
    if (way.norm() <= options_.search_radius + 2.0 * drift) within.push_back(entry);
  }
  return best(std::move(within), options_.max_spatial);
}

std::vector<LoopCandidate> LoopClosureDetector::alike(const Query& query) const {
  const MapKeyframe& source = keyframe(query.records, query.source);
  std::vector<Scored> scored;
  const int component = query.graph.component(query.source);
  const auto elsewhere = [&](int node) { return query.graph.component(node) != component; };
  if (query.graph.components() == 1 || options_.max_appearance == 0) return {};
  for (const int target :
       appearances_.mostAlike(source.keyframe->descriptor, elsewhere, kShortlist)) {
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
  const KeyframeRecord& source = query.records[static_cast<std::size_t>(query.source)];
  std::vector<int> targets = source.hinted_by;
  for (const KeyframeId& hint : source.keyframe->keyframe->closure_hints) {
    const std::optional<int> target = query.graph.find(hint);
    if (target && *target != query.source) targets.push_back(*target);
  }
  int hinted_candidates = 0;
  for (const int target : targets) {
    if (hinted_candidates == kMostHinted) break;
    const bool known =
        std::any_of(candidates.begin(), candidates.end(),
                    [&](const LoopCandidate& candidate) { return candidate.target == target; });
    if (known) continue;
    const bool located = query.graph.component(target) == query.graph.component(query.source);
    if (located && !isRevisit(query, target)) continue;
    std::vector<Scored> hinted{{0.0, {target, query.source, located, 0.0, 0.0}}};
    if (located) measure(query, hinted);
    candidates.push_back(hinted.front().second);
    ++hinted_candidates;
  }
}

}  // namespace planecloud

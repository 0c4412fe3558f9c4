// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/backend_node/closure_consistency.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "planecloud_slam/backend_node/consistent_group.h"

namespace planecloud {
namespace {

/// Of the closures in the graph the nearest ones are asked: far ones contradict nothing small.
constexpr std::size_t kMostWitnesses = 5;

/// The two components a closure connects, the older first.
std::pair<int, int> componentsOf(const PoseGraph& graph, const GraphEdge& closure) {
  return std::minmax({graph.component(graph.find(closure.from).value()),
                      graph.component(graph.find(closure.to).value())});
}

}  // namespace

ClosureAdmission ClosureConsistency::offer(const PoseGraph& graph, const GraphEdge& closure,
                                           const JoinJudge& holds) {
  const auto [older, younger] = componentsOf(graph, closure);
  const bool intra = older == younger;
  // Inside a component odometry vouches for itself over long ways; only neighbours add to it.
  const double limit = intra ? options_.max_path : std::numeric_limits<double>::infinity();
  const ClosureComparison comparison(graph, closure, drift_, limit);
  const Testimony testimony = intra ? hear(graph, comparison) : Testimony();
  ClosureAdmission admission;
  if (testimony.contradicting > testimony.agreeing) {
    admission.rejected.push_back(closure);
    return admission;
  }
  Pending offered{closure, next_serial_++, {}};
  makeKnown(comparison, offered);
  pending_.push_back(std::move(offered));
  admission = intra ? admitIntra(graph, testimony) : admitInter(graph, holds);
  if (pending_.size() > static_cast<std::size_t>(options_.max_pending)) {
    admission.expired.push_back(std::move(pending_.front().closure));
    pending_.erase(pending_.begin());
  }
  return admission;
}

ClosureConsistency::Testimony ClosureConsistency::hear(const PoseGraph& graph,
                                                       const ClosureComparison& comparison) const {
  std::vector<std::pair<double, GraphEdge>> witnesses;
  for (const int position : comparison.neighbours()) {
    const GraphEdge edge = graph.edges()[static_cast<std::size_t>(position)];
    witnesses.emplace_back(comparison.path(edge), edge);
  }
  std::stable_sort(witnesses.begin(), witnesses.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  witnesses.resize(std::min(witnesses.size(), kMostWitnesses));
  Testimony testimony;
  for (const auto& [path, edge] : witnesses) {
    const ClosureComparison::Result result = comparison.compare(edge);
    if (result.distance > options_.max_distance) {
      ++testimony.contradicting;
    } else if (result.independent) {
      ++testimony.agreeing;
    }
  }
  return testimony;
}

void ClosureConsistency::makeKnown(const ClosureComparison& comparison, Pending& offered) {
  for (Pending& other : pending_) {
    const ClosureComparison::Result result = comparison.compare(other.closure);
    if (!std::isfinite(result.path)) continue;
    if (result.distance > options_.max_distance) continue;
    offered.agrees.insert(other.serial);
    other.agrees.insert(offered.serial);
  }
}

std::vector<std::size_t> ClosureConsistency::peersOfLast(const PoseGraph& graph) const {
  const std::pair<int, int> components = componentsOf(graph, pending_.back().closure);
  std::vector<std::size_t> peers;
  for (std::size_t i = 0; i < pending_.size(); ++i) {
    if (componentsOf(graph, pending_[i].closure) == components) peers.push_back(i);
  }
  return peers;
}

std::vector<std::size_t> ClosureConsistency::groupAmong(
    const std::vector<std::size_t>& members) const {
  ConsistencyMatrix agrees(members.size(), std::vector<bool>(members.size(), false));
  for (std::size_t i = 0; i < members.size(); ++i) {
    const std::set<std::size_t>& consistent = pending_[members[i]].agrees;
    for (std::size_t j = 0; j < members.size(); ++j) {
      agrees[i][j] = consistent.count(pending_[members[j]].serial) > 0;
    }
  }
  std::vector<std::size_t> group;
  for (const std::size_t i : largestConsistentGroup(agrees)) group.push_back(members[i]);
  return group;
}

ClosureAdmission ClosureConsistency::admitIntra(const PoseGraph& graph,
                                                const Testimony& testimony) {
  const Pending& last = pending_.back();
  std::vector<std::size_t> friends;
  for (const std::size_t i : peersOfLast(graph)) {
    if (last.agrees.count(pending_[i].serial) > 0) friends.push_back(i);
  }
  std::vector<std::size_t> group = groupAmong(friends);
  group.push_back(pending_.size() - 1);
  ClosureAdmission admission;
  const std::size_t witnesses = countIndependent(closuresAt(group)) + testimony.agreeing;
  if (witnesses >= static_cast<std::size_t>(options_.min_intra)) admission.closures = take(group);
  return admission;
}

ClosureAdmission ClosureConsistency::admitInter(const PoseGraph& graph, const JoinJudge& holds) {
  const std::vector<std::size_t> peers = peersOfLast(graph);
  const std::vector<std::size_t> group = groupAmong(peers);
  ClosureAdmission admission;
  std::vector<GraphEdge> closures = closuresAt(group);
  if (countIndependent(closures) < static_cast<std::size_t>(options_.min_inter)) return admission;
  // The last one is in no group: what the others say has been judged before.
  if (group.back() + 1 != pending_.size()) return admission;
  std::vector<std::size_t> others;
  std::set_difference(peers.begin(), peers.end(), group.begin(), group.end(),
                      std::back_inserter(others));
  if (2 * groupAmong(others).size() > group.size()) return admission;
  admission.join = solveComponentJoin(graph, closures, options_, drift_);
  if (admission.join && !holds(*admission.join, closures)) admission.join.reset();
  if (!admission.join) return admission;
  // What did not agree with the group that joined is false.
  admission.rejected = closuresAt(others);
  static_cast<void>(take(peers));
  admission.closures = std::move(closures);
  return admission;
}

std::size_t ClosureConsistency::countIndependent(const std::vector<GraphEdge>& closures) {
  std::set<KeyframeId> used;
  std::size_t count = 0;
  for (const GraphEdge& closure : closures) {
    if (used.count(closure.from) > 0 || used.count(closure.to) > 0) continue;
    used.insert({closure.from, closure.to});
    ++count;
  }
  return count;
}

std::vector<GraphEdge> ClosureConsistency::closuresAt(
    const std::vector<std::size_t>& positions) const {
  std::vector<GraphEdge> closures;
  for (const std::size_t i : positions) closures.push_back(pending_[i].closure);
  return closures;
}

std::vector<GraphEdge> ClosureConsistency::take(const std::vector<std::size_t>& positions) {
  std::vector<GraphEdge> taken;
  std::vector<Pending> left;
  for (std::size_t i = 0; i < pending_.size(); ++i) {
    if (std::find(positions.begin(), positions.end(), i) != positions.end()) {
      taken.push_back(std::move(pending_[i].closure));
    } else {
      left.push_back(std::move(pending_[i]));
    }
  }
  pending_ = std::move(left);
  return taken;
}

}  // namespace planecloud

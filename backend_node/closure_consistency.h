// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <set>
#include <vector>

#include "planecloud_slam/backend_node/closure_comparison.h"
#include "planecloud_slam/backend_node/component_join.h"
#include "planecloud_slam/backend_node/loop_closure_options.h"
#include "planecloud_slam/backend_node/map_snapshot.h"
#include "planecloud_slam/backend_node/pose_graph.h"

namespace planecloud {

/// What becomes of an offered closure.
struct ClosureAdmission {
  std::vector<GraphEdge> closures;    ///< enter the graph now; empty: it waits or was rejected
  std::optional<ComponentJoin> join;  ///< to apply before they enter
  std::vector<GraphEdge> rejected;    ///< contradict the others
  std::vector<GraphEdge> expired;     ///< waited in vain
};

/// Lets a closure into the graph when enough others agree with it (pairwise consistency); closures
/// that share a keyframe share its errors and count as one. Inside a component a neighbour must
/// vouch, in the graph already or waiting. Between components a group must form that fixes all six
/// directions even without any one of its members and has no rival of more than half its size.
class ClosureConsistency {
 public:
  /// Says whether a join that `closures` propose holds otherwise.
  using JoinJudge =
      std::function<bool(const ComponentJoin& join, const std::vector<GraphEdge>& closures)>;

  ClosureConsistency(const ClosureConsistencyOptions& options, const DriftOptions& drift)
      : options_(options), drift_(drift) {}

  /// Judges a verified closure between two keyframes of `graph`; `holds` has a last word on joins.
  [[nodiscard]] ClosureAdmission offer(const PoseGraph& graph, const GraphEdge& closure,
                                       const JoinJudge& holds);

  void clear() { pending_.clear(); }

 private:
  struct Pending {
    GraphEdge closure;
    std::size_t serial = 0;
    std::set<std::size_t> agrees;  ///< serials of the consistent ones
  };
  /// What the closures in the graph say of a new one.
  struct Testimony {
    std::size_t agreeing = 0;
    std::size_t contradicting = 0;
  };

  void makeKnown(const ClosureComparison& comparison, Pending& offered);
  [[nodiscard]] Testimony hear(const PoseGraph& graph, const ClosureComparison& comparison) const;
  [[nodiscard]] ClosureAdmission admitIntra(const PoseGraph& graph, const Testimony& testimony);
  [[nodiscard]] ClosureAdmission admitInter(const PoseGraph& graph, const JoinJudge& holds);
  /// How many of `closures` share no keyframe with one another.
  [[nodiscard]] static std::size_t countIndependent(const std::vector<GraphEdge>& closures);
  /// Positions in `pending_` of those between the same components as the last.
  [[nodiscard]] std::vector<std::size_t> peersOfLast(const PoseGraph& graph) const;
  [[nodiscard]] std::vector<std::size_t> groupAmong(const std::vector<std::size_t>& members) const;
  [[nodiscard]] std::vector<GraphEdge> closuresAt(const std::vector<std::size_t>& positions) const;
  [[nodiscard]] std::vector<GraphEdge> take(const std::vector<std::size_t>& positions);

  ClosureConsistencyOptions options_;
  DriftOptions drift_;
  std::vector<Pending> pending_;  ///< oldest first
  std::size_t next_serial_ = 0;
};

}  // namespace planecloud

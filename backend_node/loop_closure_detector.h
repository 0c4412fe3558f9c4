// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "planecloud_slam/backend_node/appearance_index.h"
#include "planecloud_slam/backend_node/keyframe_record.h"
#include "planecloud_slam/backend_node/loop_closure_options.h"
#include "planecloud_slam/backend_node/pose_graph.h"

namespace planecloud {

/// A pair of keyframes that may show the same place.
struct LoopCandidate {
  int target = 0;        ///< node number of the older keyframe
  int source = 0;        ///< node number of the newer keyframe
  bool located = false;  ///< both in one component: their relative pose is known roughly
  double path = 0.0;     ///< of measurements between them when located, see motionLength [m]
  double turn = 0.0;     ///< otherwise: how far right the source looks, by appearance [rad]
};

/// Proposes loop closures (ALGORITHMS 6.1): by position inside a component, by appearance and by
/// the frontend's hints elsewhere. Proposing is cheap and generous, see ClosureVerifier.
class LoopClosureDetector {
 public:
  LoopClosureDetector(const LoopCandidateOptions& options, const DriftOptions& drift)
      : options_(options), drift_(drift) {}

  /// Candidates for keyframe `source`, best first, located ones before the others. No pair twice.
  /// Of one map only, which may grow from call to call.
  [[nodiscard]] std::vector<LoopCandidate> detect(const PoseGraph& graph,
                                                  const KeyframeRecords& records, int source);

 private:
  struct Query {
    const PoseGraph& graph;
    const KeyframeRecords& records;
    int source;
  };
  /// A candidate with what it is judged by: the smaller, the better.
  using Scored = std::pair<double, LoopCandidate>;

  [[nodiscard]] bool isRevisit(const Query& query, int target) const;
  /// How unlike the views of the two keyframes are where they are thought to be, [0, 1]; none when
  /// too far apart to be tried.
  [[nodiscard]] std::optional<double> misfit(const Query& query, int target) const;
  [[nodiscard]] std::vector<LoopCandidate> near(const Query& query) const;
  [[nodiscard]] std::vector<LoopCandidate> alike(const Query& query) const;
  /// Adds the length of the way to each.
  static void measure(const Query& query, std::vector<Scored>& located);
  void addHints(const Query& query, std::vector<LoopCandidate>& candidates) const;

  LoopCandidateOptions options_;
  DriftOptions drift_;
  AppearanceIndex appearances_;  ///< of the records seen so far
};

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "planecloud_slam/backend_node/coplanarity.h"
#include "planecloud_slam/backend_node/flat_surface.h"
#include "planecloud_slam/backend_node/graph_edge.h"
#include "planecloud_slam/backend_node/keyframe_record.h"
#include "planecloud_slam/backend_node/loop_closure_options.h"
#include "planecloud_slam/backend_node/pose_graph.h"
#include "planecloud_slam/icap/icap_options.h"

namespace planecloud {

/// Finds keyframes that see another part of a flat surface a new one sees, where their views
/// overlap too little for a loop closure (paper sec. 4.4). A pair counts only
/// where nothing else can be meant: keyframes just before or after confirm both parts, none of them
/// saw another parallel surface within what is not known of the relative pose, and neither of the
/// two saw through the part that the other one sees.
class CoplanarityDetector {
 public:
  CoplanarityDetector(const LoopClosureOptions& options, const IcapOptions& icap)
      : options_(options), icap_(icap) {}

  /// Edges of kind kCoplanar from earlier keyframes to `source`, the newest node of `graph`, whose
  /// planes are `planes`. To be called for every node in turn.
  [[nodiscard]] std::vector<GraphEdge> detect(const PoseGraph& graph,
                                              const KeyframeRecords& records, int source,
                                              const PlaneCloud& planes);

 private:
  struct Query {
    const PoseGraph& graph;
    const KeyframeRecords& records;
    int source;
  };
  struct Candidate {
    int target = 0;
    FlatSurface* target_surface = nullptr;
    const FlatSurface* source_surface = nullptr;
    double path = 0.0;  ///< of measurements between the keyframes [m]
    double gain = 0.0;  ///< how much surer the three directions would become [-]
    GraphEdge edge;
  };

  /// Compares the surfaces of the source with those of keyframes just before it.
  void lookBack(const Query& query);
  /// Whether the keyframes lie in one component and far enough apart on their way.
  [[nodiscard]] bool mayPair(const Query& query, int target) const;
  [[nodiscard]] std::vector<Candidate> propose(const Query& query);
  /// Completes the candidate; false when it does not hold.
  [[nodiscard]] bool judge(const Query& query, Candidate& candidate) const;
  /// Whether the two views overlap little and contradict each other nowhere.
  [[nodiscard]] bool viewsAllow(const Query& query, const Candidate& candidate,
                                const Eigen::Isometry3d& T_target_source) const;
  [[nodiscard]] static GraphEdge makeEdge(const Query& query, const Candidate& candidate,
                                          const Eigen::Isometry3d& T_target_source,
                                          const Coplanarity& fitted);

  LoopClosureOptions options_;
  IcapOptions icap_;
  std::vector<std::vector<FlatSurface>> surfaces_;  ///< by node
};

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <set>
#include <vector>

#include "planecloud_slam/backend_node/backend_options.h"
#include "planecloud_slam/backend_node/keyframe_record.h"
#include "planecloud_slam/backend_node/map_snapshot.h"
#include "planecloud_slam/backend_node/pose_graph.h"

namespace planecloud {

/// The keyframes and their pose graph. Knows where a new keyframe goes, which edges and hints have
/// to wait for keyframes still under way, and how the frame of a component is levelled.
class KeyframeMap {
 public:
  KeyframeMap(const PoseGraphOptions& graph, const MapFrameOptions& frame)
      : frame_(frame), graph_(graph) {}

  /// Adds a checked keyframe with its decoded planes, its edges and those that waited for it.
  /// Returns its node number. Throws std::invalid_argument when its id is there already.
  int add(Keyframe keyframe, const PlaneCloud& planes);

  [[nodiscard]] PoseGraph& graph() { return graph_; }
  [[nodiscard]] const PoseGraph& graph() const { return graph_; }
  [[nodiscard]] const KeyframeRecords& records() const { return records_; }

  /// A picture of it all, without revision and rejected closures.
  [[nodiscard]] MapSnapshot snapshot() const;

 private:
  [[nodiscard]] std::optional<int> predecessor(const KeyframeId& id) const;
  [[nodiscard]] Eigen::Isometry3d initialPose(const Keyframe& keyframe,
                                              const std::vector<GraphEdge>& edges) const;
  [[nodiscard]] KeyframeRecord makeRecord(Keyframe keyframe, const PlaneCloud& planes) const;
  void followHints(int node);
  void connect(const GraphEdge& edge);
  void level(int node, const PlaneCloud& planes);

  MapFrameOptions frame_;
  PoseGraph graph_;
  KeyframeRecords records_;
  std::map<KeyframeId, std::vector<GraphEdge>> waiting_;  ///< by the end that has not arrived
  std::map<KeyframeId, std::vector<int>> hinted_by_;  ///< likewise: who hints at what is to come
  std::set<KeyframeId> levelled_;  ///< oldest keyframes of components that have found their floor
};

}  // namespace planecloud

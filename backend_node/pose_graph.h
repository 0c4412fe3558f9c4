// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <limits>
#include <map>
#include <optional>
#include <vector>

#include "planecloud_slam/backend_node/backend_options.h"
#include "planecloud_slam/backend_node/edge_list.h"
#include "planecloud_slam/backend_node/graph_components.h"
#include "planecloud_slam/backend_node/graph_edge.h"
#include "planecloud_slam/backend_node/place_grid.h"

namespace planecloud {

/// What an optimisation did.
struct OptimisationSummary {
  int iterations = 0;
  double initial_cost = 0.0;  ///< half the sum of squared residuals, robust kernel applied
  double final_cost = 0.0;
  std::vector<GraphEdge> removed;  ///< closures and coplanar edges found false and taken out
};

/// Poses of keyframes and the measurements between them (paper sec. 3.1). Nodes are numbered in the
/// order of arrival; connected components are numbered by their oldest node, whose pose is fixed in
/// optimisations, so each component keeps its own frame. Deterministic with one thread.
class PoseGraph {
 public:
  /// Throws std::invalid_argument when `options` fail their check.
  explicit PoseGraph(const PoseGraphOptions& options);

  /// Returns the new node's number. Throws std::invalid_argument when `id` is there already.
  int addNode(const KeyframeId& id, const Eigen::Isometry3d& T_map_camera);
  /// Throws std::invalid_argument when an end is missing or both are the same node.
  void addEdge(const GraphEdge& edge);

  [[nodiscard]] std::optional<int> find(const KeyframeId& id) const;
  /// All nodes in order of robot, session and number.
  [[nodiscard]] const std::map<KeyframeId, int>& numbers() const { return numbers_; }
  [[nodiscard]] int size() const { return static_cast<int>(nodes_.size()); }
  [[nodiscard]] const KeyframeId& id(int node) const { return at(node).id; }
  [[nodiscard]] const Eigen::Isometry3d& pose(int node) const { return at(node).T_map_camera; }
  [[nodiscard]] int component(int node) const { return components_.of(node); }
  [[nodiscard]] int components() const { return components_.count(); }
  /// Nodes of a component, ascending.
  [[nodiscard]] const std::vector<int>& members(int component) const {
    return components_.members(component);
  }
  [[nodiscard]] const EdgeList& edges() const { return edges_; }
  /// How many closures there are between robots or within one.
  [[nodiscard]] std::size_t closures(bool inter_robot) const {
    return inter_robot ? closures_inter_ : closures_intra_;
  }
  [[nodiscard]] std::size_t coplanarEdges() const { return coplanar_; }
  /// Positions in `edges` of those at `node`.
  [[nodiscard]] const std::vector<int>& edgesOf(int node) const {
    return edges_of_.at(static_cast<std::size_t>(node));
  }
  /// All nodes, of whatever component, within `radius` [m] of `node` and some a little farther.
  [[nodiscard]] std::vector<int> nodesAround(int node, double radius) const {
    return places_.around(pose(node).translation(), radius);
  }

  /// Moves every pose of a component: `T_map_camera <- T_new_old * T_map_camera`.
  void moveComponent(int component, const Eigen::Isometry3d& T_new_old);

  /// Length of the shortest path of measurements from `node` to every node (see motionLength), in
  /// order of nodes [m]; infinite between components and where it is longer than `limit`. Edges
  /// that leave a direction unobserved are no way.
  [[nodiscard]] std::vector<double> pathLengths(
      int node, double limit = std::numeric_limits<double>::infinity()) const;
  /// The same for `targets` alone, in their order. Looks no farther than it has to.
  [[nodiscard]] std::vector<double> pathLengthsTo(int node, const std::vector<int>& targets) const;

  /// Squared Mahalanobis distance between an edge of the graph and the present poses.
  [[nodiscard]] double squaredError(const GraphEdge& edge) const;

  /// Optimises the `local_window` nodes that fewest edges lie between them and `seeds`, all others
  /// fixed; nothing is found false. Costs the same however large the graph is.
  OptimisationSummary optimizeAround(const std::vector<int>& seeds);

  /// Takes over what became of `copy`, a copy of this graph that was optimised while this one went
  /// on: poses, closures found false. Nodes added since go with the older node their robot's own
  /// edges hang them on; closures since then are for `optimizeAround`. Returns the edges that left.
  std::vector<GraphEdge> adopt(const PoseGraph& copy, const OptimisationSummary& summary);

  /// Optimises all components; a closure or coplanar edge that then disagrees by more than
  /// `removal_distance` leaves, the worst first, each time followed by another optimisation.
  OptimisationSummary optimize();

 private:
  struct Node {
    KeyframeId id;
    Eigen::Isometry3d T_map_camera = Eigen::Isometry3d::Identity();
  };
  struct Ends {
    int from = 0;
    int to = 0;
    double length = 0.0;   ///< see motionLength [m]
    bool complete = true;  ///< observes all six directions
    [[nodiscard]] int opposite(int node) const { return from == node ? to : from; }
  };

  [[nodiscard]] const Node& at(int node) const { return nodes_.at(static_cast<std::size_t>(node)); }
  void setPose(int node, const Eigen::Isometry3d& T_map_camera);
  /// Where edges of its kind are counted, null for the frontend's.
  [[nodiscard]] std::size_t* counterOf(const GraphEdge& edge);
  void eraseEdge(std::size_t edge);
  /// Coplanar edges alone hold no component together: those left between two are taken out.
  void findComponents();
  [[nodiscard]] std::vector<int> window(const std::vector<int>& seeds) const;
  /// Calls `settle(node, length)` in order of the length of the way from `node` until it says no.
  template <typename Settle>
  void walk(int node, Settle&& settle) const;
  void solve(OptimisationSummary& summary);
  [[nodiscard]] std::optional<std::size_t> worstOfBackend() const;

  PoseGraphOptions options_;
  std::vector<Node> nodes_;
  std::map<KeyframeId, int> numbers_;
  EdgeList edges_;
  std::vector<Ends> ends_;                  ///< of `edges_`, same order
  std::vector<std::vector<int>> edges_of_;  ///< of each node, positions in `edges_`
  std::size_t closures_intra_ = 0;
  std::size_t closures_inter_ = 0;
  std::size_t coplanar_ = 0;
  GraphComponents components_;
  PlaceGrid places_;
};

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "planecloud_slam/plane_fit/moment_pyramid.h"
#include "planecloud_slam/plane_fit/tile_fitter.h"

namespace planecloud {

/// Chooses the tiles that cost least: distortion + lambda * bits, bottom up (rate-distortion
/// pruning as in Chou, Lookabaugh and Gray 1989). Distortion is the error summed over the pixels in
/// units of the tolerance and follows from the moments alone: no pass over pixels. Looks at the
/// tree breadth first, so that it can stop anywhere and still choose well among what it has seen.
class TreePruner {
 public:
  /// Keeps references to `pyramid`, whose nodes it splits, and `fitter`.
  TreePruner(MomentPyramid& pyramid, const TileFitter& fitter, double lambda);

  /// The tiles in coding order. `give_up` (asked every few nodes) ends the descent: the result is
  /// then coarser. Valid until the next call.
  [[nodiscard]] const std::vector<QuadtreeNode>& choose(const std::function<bool()>& give_up);

 private:
  enum class Choice : std::uint8_t { kNothing, kTile, kSplit };
  struct Node {
    float cost = 0.0F;
    Choice choice = Choice::kNothing;
    bool open = false;  ///< its children were weighed as well
  };

  struct Level {
    int columns = 0;
    std::vector<Node> nodes;
  };

  [[nodiscard]] Level& level(int i) { return levels_[static_cast<std::size_t>(i)]; }
  [[nodiscard]] std::size_t index(const QuadtreeNode& node) const {
    const Level& nodes = levels_[static_cast<std::size_t>(node.level)];
    return static_cast<std::size_t>(node.row * nodes.columns + node.column);
  }
  [[nodiscard]] Node& at(const QuadtreeNode& node) { return level(node.level).nodes[index(node)]; }
  /// Calls `visit(column, row, index)` for each child with depth.
  template <typename Visit>
  void forChildren(const QuadtreeNode& node, Visit&& visit) const;
  [[nodiscard]] bool weighLevel(std::size_t i, const std::function<bool()>& give_up);
  /// Time is up: the nodes from `first` on were not weighed, so their parents cannot split.
  void dropFrom(std::vector<QuadtreeNode>& queue, std::size_t first);
  /// Tile or nothing, and whether it is worth a look at the children.
  Node& weigh(const QuadtreeNode& node);
  void pushChildren(const QuadtreeNode& node, std::vector<QuadtreeNode>& queue) const;
  /// Splits where the children together cost less.
  void merge(const QuadtreeNode& node);
  void collect();

  MomentPyramid& pyramid_;
  const TileFitter& fitter_;
  float split_cost_, tile_cost_, nothing_cost_;
  std::vector<Level> levels_;
  std::vector<std::vector<QuadtreeNode>> queues_;  // nodes weighed on each level
  std::vector<QuadtreeNode> tiles_;
};

}  // namespace planecloud

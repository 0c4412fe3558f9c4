// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/plane_fit/tree_pruner.h"

#include <algorithm>
#include <optional>

namespace planecloud {
namespace {

/// What the coder spends on recorded frames, about.
constexpr double kTileBits = 14.0;
constexpr double kSplitBits = 1.5;
constexpr double kNothingBits = 1.5;
/// A tile's mean error may be this many tolerances; what fits no better stays uncovered.
constexpr float kMaxError = 2.0F;
/// Covering comes first: a pixel without a plane counts as this many tolerances, more than all of
/// the largest tile. So coverage never falls when more time lets the tree grow deeper.
constexpr double kUncoveredError = 1e4;
/// Nodes between two looks at the clock.
constexpr int kNodesAtOnce = 32;

}  // namespace

TreePruner::TreePruner(const MomentPyramid& pyramid, const TileFitter& fitter, double lambda)
    : pyramid_(pyramid), fitter_(fitter), lambda_(lambda) {
  const QuadtreeGrid& grid = pyramid.grid();
  levels_.resize(static_cast<std::size_t>(grid.levels()));
  queues_.resize(levels_.size());
  for (int i = 0; i < grid.levels(); ++i) {
    level(i).resize(static_cast<std::size_t>(grid.columns(i)) *
                    static_cast<std::size_t>(grid.rows(i)));
  }
}

std::size_t TreePruner::index(const QuadtreeNode& node) const {
  return static_cast<std::size_t>(node.row) *
             static_cast<std::size_t>(pyramid_.grid().columns(node.level)) +
         static_cast<std::size_t>(node.column);
}

const std::vector<QuadtreeNode>& TreePruner::choose(const std::function<bool()>& give_up) {
  for (std::vector<QuadtreeNode>& queue : queues_) queue.clear();
  for (int row = 0; row < pyramid_.grid().rows(0); ++row) {
    for (int column = 0; column < pyramid_.grid().columns(0); ++column) {
      if (pyramid_.count({0, column, row}) > 0) queues_[0].push_back({0, column, row});
    }
  }
  bool on_time = true;
  for (std::size_t i = 0; i < queues_.size() && on_time; ++i) on_time = weighLevel(i, give_up);
  for (std::size_t i = queues_.size() - 1; i-- > 0;) {
    for (const QuadtreeNode& node : queues_[i]) merge(node);
  }
  collect();
  return tiles_;
}

bool TreePruner::weighLevel(std::size_t i, const std::function<bool()>& give_up) {
  std::vector<QuadtreeNode>& queue = queues_[i];
  for (std::size_t j = 0; j < queue.size(); ++j) {
    if (j % kNodesAtOnce == 0 && give_up && give_up()) {
      dropFrom(queue, j);
      return false;
    }
    Node& state = weigh(queue[j]);
    state.open = state.open && i + 1 < queues_.size();
    if (state.open) pushChildren(queue[j], queues_[i + 1]);
  }
  return true;
}

void TreePruner::dropFrom(std::vector<QuadtreeNode>& queue, std::size_t first) {
  for (std::size_t j = 0; j < queue.size(); ++j) {
    const QuadtreeNode node = queue[j];
    level(node.level)[index(node)].open = false;
    if (j < first) continue;
    if (node.level > 0) {
      const QuadtreeNode parent{node.level - 1, node.column / 2, node.row / 2};
      level(parent.level)[index(parent)].open = false;
    }
  }
  queue.resize(first);
}

TreePruner::Node& TreePruner::weigh(const QuadtreeNode& node) {
  const auto count = static_cast<float>(pyramid_.count(node));
  Node& state = level(node.level)[index(node)];
  state = {kUncoveredError * count + lambda_ * kNothingBits, Choice::kNothing, true};
  const std::optional<float> distortion = fitter_.distortion(node);
  if (!distortion || *distortion > kMaxError * count) return state;
  const double cost = *distortion + lambda_ * kTileBits;
  // A split makes a tile of each child with depth, or costs far more: is that worth a look?
  const double least = lambda_ * (kSplitBits + kTileBits * countChildren(node));
  state = {cost, Choice::kTile, least < cost};
  return state;
}

int TreePruner::countChildren(const QuadtreeNode& node) const {
  if (node.level + 1 == pyramid_.grid().levels()) return 0;
  int children = 0;
  for (const int row : {2 * node.row, 2 * node.row + 1}) {
    for (const int column : {2 * node.column, 2 * node.column + 1}) {
      children += pyramid_.count({node.level + 1, column, row}) > 0 ? 1 : 0;
    }
  }
  return children;
}

void TreePruner::pushChildren(const QuadtreeNode& node, std::vector<QuadtreeNode>& queue) const {
  for (const int row : {2 * node.row, 2 * node.row + 1}) {
    for (const int column : {2 * node.column, 2 * node.column + 1}) {
      const QuadtreeNode child{node.level + 1, column, row};
      if (pyramid_.count(child) > 0) queue.push_back(child);
    }
  }
}

void TreePruner::merge(const QuadtreeNode& node) {
  Node& state = level(node.level)[index(node)];
  if (!state.open) return;
  const std::vector<Node>& children = level(node.level + 1);
  double cost = lambda_ * kSplitBits;
  for (const int row : {2 * node.row, 2 * node.row + 1}) {
    for (const int column : {2 * node.column, 2 * node.column + 1}) {
      const QuadtreeNode child{node.level + 1, column, row};
      if (pyramid_.count(child) == 0) continue;
      cost += children[index(child)].cost;
    }
  }
  if (cost < state.cost) state = {cost, Choice::kSplit, true};
}

void TreePruner::collect() {
  tiles_.clear();
  // From here on the queues hold the nodes of the chosen trees.
  for (std::size_t i = 0; i < queues_.size(); ++i) {
    if (i + 1 < queues_.size()) queues_[i + 1].clear();
    for (const QuadtreeNode& node : queues_[i]) {
      const Choice choice = level(node.level)[index(node)].choice;
      if (choice == Choice::kTile) tiles_.push_back(node);
      if (choice == Choice::kSplit) pushChildren(node, queues_[i + 1]);
    }
  }
}

}  // namespace planecloud

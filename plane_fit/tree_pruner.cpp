// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/plane_fit/tree_pruner.h"

#include <algorithm>

namespace planecloud {
namespace {

/// What the coder spends on recorded frames, about.
constexpr float kTileBits = 14.0F;
constexpr float kSplitBits = 1.5F;
constexpr float kNothingBits = 1.5F;
/// A tile's mean error may be this many tolerances; what fits no better stays uncovered.
constexpr float kMaxError = 2.0F;
/// Covering comes first: a pixel without a plane counts as this many tolerances, more than all of
/// the largest tile. So coverage never falls when more time lets the tree grow deeper.
constexpr float kUncoveredError = 1e4F;
/// Nodes between two looks at the clock.
constexpr int kNodesAtOnce = 32;

}  // namespace

TreePruner::TreePruner(MomentPyramid& pyramid, const TileFitter& fitter, double lambda)
    : pyramid_(pyramid),
      fitter_(fitter),
      split_cost_(static_cast<float>(lambda) * kSplitBits),
      tile_cost_(static_cast<float>(lambda) * kTileBits),
      nothing_cost_(static_cast<float>(lambda) * kNothingBits) {
  const QuadtreeGrid& grid = pyramid.grid();
  levels_.resize(static_cast<std::size_t>(grid.levels()));
  queues_.resize(levels_.size());
  for (int i = 0; i < grid.levels(); ++i) {
    level(i).columns = grid.columns(i);
    level(i).nodes.resize(static_cast<std::size_t>(grid.columns(i)) *
                          static_cast<std::size_t>(grid.rows(i)));
  }
}

template <typename Visit>
void TreePruner::forChildren(const QuadtreeNode& node, Visit&& visit) const {
  if (node.level + 1 == static_cast<int>(levels_.size())) return;
  const std::vector<Fill>& fills = pyramid_.fills(node.level + 1);
  const auto columns =
      static_cast<std::size_t>(levels_[static_cast<std::size_t>(node.level) + 1].columns);
  const int column = 2 * node.column;
  const int row = 2 * node.row;
  const std::size_t first =
      static_cast<std::size_t>(row) * columns + static_cast<std::size_t>(column);
  const auto has_depth = [&](std::size_t i) { return fills[i] != Fill::kNothing; };
  if (has_depth(first)) visit(column, row, first);
  if (has_depth(first + 1)) visit(column + 1, row, first + 1);
  if (has_depth(first + columns)) visit(column, row + 1, first + columns);
  if (has_depth(first + columns + 1)) visit(column + 1, row + 1, first + columns + 1);
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
    if (!state.open) continue;
    pyramid_.split(queue[j]);
    pushChildren(queue[j], queues_[i + 1]);
  }
  return true;
}

void TreePruner::dropFrom(std::vector<QuadtreeNode>& queue, std::size_t first) {
  for (std::size_t j = 0; j < queue.size(); ++j) {
    const QuadtreeNode node = queue[j];
    at(node).open = false;
    if (j < first) continue;
    if (node.level > 0) {
      const QuadtreeNode parent{node.level - 1, node.column / 2, node.row / 2};
      at(parent).open = false;
    }
  }
  queue.resize(first);
}

TreePruner::Node& TreePruner::weigh(const QuadtreeNode& node) {
  const std::size_t i = index(node);
  const float count = pyramid_.counts(node.level)[i];
  Node& state = level(node.level).nodes[i];
  const float distortion = fitter_.distortion(node);
  // Field by field, here and below: what is made whole and copied at once waits for its own stores.
  state.open = true;
  if (distortion < 0.0F || distortion > kMaxError * count) {
    state.cost = kUncoveredError * count + nothing_cost_;
    state.choice = Choice::kNothing;
    return state;
  }
  state.cost = distortion + tile_cost_;
  state.choice = Choice::kTile;
  // A split makes a tile of each child with depth, or costs far more: is that worth a look?
  state.open = distortion > split_cost_;
  if (!state.open) return state;
  const auto children = static_cast<float>(pyramid_.countChildren(node));
  state.open = split_cost_ + tile_cost_ * children < state.cost;
  return state;
}

void TreePruner::pushChildren(const QuadtreeNode& node, std::vector<QuadtreeNode>& queue) const {
  // As if all had depth: one look at the queue's room for the four of them.
  const std::size_t first = queue.size();
  queue.resize(first + 4);
  QuadtreeNode* child = &queue[first];
  forChildren(node, [&](int column, int row, std::size_t) {
    child->level = node.level + 1;
    child->column = column;
    child->row = row;
    ++child;
  });
  queue.resize(static_cast<std::size_t>(child - queue.data()));
}

void TreePruner::merge(const QuadtreeNode& node) {
  Node& state = at(node);
  if (!state.open) return;
  const std::vector<Node>& children = level(node.level + 1).nodes;
  float cost = split_cost_;
  forChildren(node, [&](int, int, std::size_t i) { cost += children[i].cost; });
  if (cost >= state.cost) return;
  state.cost = cost;
  state.choice = Choice::kSplit;
}

void TreePruner::collect() {
  tiles_.clear();
  // From here on the queues hold the nodes of the chosen trees.
  for (std::size_t i = 0; i < queues_.size(); ++i) {
    if (i + 1 < queues_.size()) queues_[i + 1].clear();
    for (const QuadtreeNode& node : queues_[i]) {
      const Choice choice = at(node).choice;
      if (choice == Choice::kTile) tiles_.push_back(node);
      if (choice == Choice::kSplit) pushChildren(node, queues_[i + 1]);
    }
  }
}

}  // namespace planecloud

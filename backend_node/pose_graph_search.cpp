// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
//
// How PoseGraph finds its way from node to node.
#include <cstddef>
#include <functional>
#include <limits>
#include <map>
#include <queue>
#include <utility>
#include <vector>

#include "planecloud_slam/backend_node/pose_graph.h"

namespace planecloud {
namespace {

std::size_t indexOf(int number) { return static_cast<std::size_t>(number); }

}  // namespace

void PoseGraph::findComponents() {
  std::vector<int> labels(nodes_.size(), -1);
  for (int root = 0; root < size(); ++root) {
    if (labels[indexOf(root)] >= 0) continue;
    std::vector<int> open{root};
    labels[indexOf(root)] = root;
    while (!open.empty()) {
      const int node = open.back();
      open.pop_back();
      for (const int e : edges_of_[indexOf(node)]) {
        if (edges_.kind(indexOf(e)) == EdgeKind::kCoplanar) continue;
        const int next = ends_[indexOf(e)].opposite(node);
        if (labels[indexOf(next)] >= 0) continue;
        labels[indexOf(next)] = root;
        open.push_back(next);
      }
    }
  }
  for (std::size_t e = edges_.size(); e-- > 0;) {
    if (labels[indexOf(ends_[e].from)] != labels[indexOf(ends_[e].to)]) eraseEdge(e);
  }
  components_.assign(labels);
}

template <typename Settle>
void PoseGraph::walk(int node, Settle&& settle) const {
  using Entry = std::pair<double, int>;
  std::vector<double> lengths(nodes_.size(), std::numeric_limits<double>::infinity());
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  lengths.at(indexOf(node)) = 0.0;
  open.emplace(0.0, node);
  while (!open.empty()) {
    const auto [length, current] = open.top();
    open.pop();
    if (length > lengths[indexOf(current)]) continue;
    if (!settle(current, length)) return;
    for (const int e : edges_of_[indexOf(current)]) {
      const Ends& ends = ends_[indexOf(e)];
      if (!ends.complete) continue;
      const int next = ends.opposite(current);
      if (length + ends.length >= lengths[indexOf(next)]) continue;
      lengths[indexOf(next)] = length + ends.length;
      open.emplace(lengths[indexOf(next)], next);
    }
  }
}

std::vector<double> PoseGraph::pathLengths(int node, double limit) const {
  std::vector<double> lengths(nodes_.size(), std::numeric_limits<double>::infinity());
  walk(node, [&](int reached, double length) {
    if (length > limit) return false;
    lengths[indexOf(reached)] = length;
    return true;
  });
  return lengths;
}

std::vector<double> PoseGraph::pathLengthsTo(int node, const std::vector<int>& targets) const {
  std::vector<double> lengths(targets.size(), std::numeric_limits<double>::infinity());
  std::multimap<int, std::size_t> wanted;  // positions in `targets` by node
  for (std::size_t i = 0; i < targets.size(); ++i) wanted.emplace(targets[i], i);
  if (wanted.empty()) return lengths;
  walk(node, [&](int reached, double length) {
    const auto [first, last] = wanted.equal_range(reached);
    for (auto entry = first; entry != last; ++entry) lengths[entry->second] = length;
    wanted.erase(first, last);
    return !wanted.empty();
  });
  return lengths;
}

std::vector<int> PoseGraph::window(const std::vector<int>& seeds) const {
  std::vector<bool> seen(nodes_.size(), false);
  std::vector<int> nodes;
  const auto visit = [&](int node) {
    if (seen[indexOf(node)] || static_cast<int>(nodes.size()) >= options_.local_window) return;
    seen[indexOf(node)] = true;
    nodes.push_back(node);
  };
  for (const int seed : seeds) visit(seed);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    for (const int e : edges_of_[indexOf(nodes[i])]) visit(ends_[indexOf(e)].opposite(nodes[i]));
  }
  return nodes;
}

}  // namespace planecloud

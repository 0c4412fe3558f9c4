// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

namespace planecloud {

/// Which nodes of a graph are connected. Components are numbered by their oldest node.
class GraphComponents {
 public:
  /// Adds the next node, connected with none.
  void add();
  /// Connects the components of two nodes. Costs what the younger component and those younger than
  /// it hold: nothing for a node just added.
  void join(int node, int other);
  /// Begins anew: `labels` tells for every node any number of its component.
  void assign(const std::vector<int>& labels);

  [[nodiscard]] int of(int node) const { return of_.at(static_cast<std::size_t>(node)); }
  [[nodiscard]] int count() const { return static_cast<int>(members_.size()); }
  /// Nodes of a component, ascending.
  [[nodiscard]] const std::vector<int>& members(int component) const {
    return members_.at(static_cast<std::size_t>(component));
  }

 private:
  std::vector<int> of_;                    ///< by node
  std::vector<std::vector<int>> members_;  ///< by component
};

}  // namespace planecloud

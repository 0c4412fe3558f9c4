// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace planecloud {

/// Nodes by where they are: finds those about a place without looking at the others, and follows
/// them when they move.
class PlaceGrid {
 public:
  /// Puts node `node` to `position` [m], wherever it was before. New nodes come in order.
  void place(int node, const Eigen::Vector3d& position);
  /// All nodes within `radius` [m] of `centre` and some that are a little farther, ascending.
  [[nodiscard]] std::vector<int> around(const Eigen::Vector3d& centre, double radius) const;

 private:
  using Cell = std::array<std::int32_t, 3>;
  struct CellHash {
    std::size_t operator()(const Cell& cell) const;
  };

  [[nodiscard]] static Cell cellAt(const Eigen::Vector3d& position);

  std::unordered_map<Cell, std::vector<int>, CellHash> nodes_;
  std::vector<Cell> cells_;  ///< by node
};

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "planecloud_slam/plane_fit/quadtree_grid.h"

namespace planecloud {

/// Place of a node in the walk through all quadtrees, breadth first: level by level, there initial
/// tile by initial tile in rows, there along the Z-curve. This is the order of a `PlaneCloud`.
[[nodiscard]] std::uint64_t codingKey(const QuadtreeGrid& grid, const QuadtreeNode& node);

/// A tile of a plane cloud and its node.
struct TileNode {
  std::uint64_t key = 0;  ///< `codingKey`
  QuadtreeNode node;
  PlanarTile tile;
};

/// The tiles with their nodes in coding order. Throws std::invalid_argument for a tile that is no
/// node of the grid and for tiles that overlap.
[[nodiscard]] std::vector<TileNode> inCodingOrder(const QuadtreeGrid& grid,
                                                  const std::vector<PlanarTile>& tiles);

}  // namespace planecloud

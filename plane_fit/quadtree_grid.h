// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "planecloud_slam/plane_fit/plane_cloud.h"

namespace planecloud {

/// A node of the quadtrees: level 0 holds the initial tiles.
struct QuadtreeNode {
  int level = 0;
  int column = 0;
  int row = 0;
  friend bool operator==(const QuadtreeNode& a, const QuadtreeNode& b) {
    return a.level == b.level && a.column == b.column && a.row == b.row;
  }
};

/// Where the nodes of a `QuadtreeLayout` lie in an image. A side of s pixels splits into
/// ceil(s / 2) and floor(s / 2) as long as ceil(s / 2) >= min_tile for both sides of the initial
/// tile, so all trees are equally deep (24-12-6-3-2, 40-20-10-5-3). Nodes are clipped at the right
/// and lower border and may be empty there. Smallest nodes are called cells.
class QuadtreeGrid {
 public:
  /// Throws std::invalid_argument for a layout out of range, naming it.
  QuadtreeGrid(const QuadtreeLayout& layout, int width, int height);

  [[nodiscard]] const QuadtreeLayout& layout() const { return layout_; }
  [[nodiscard]] int width() const { return x_.back(); }
  [[nodiscard]] int height() const { return y_.back(); }
  /// Number of levels, at least 1; cells are on level `levels() - 1`.
  [[nodiscard]] int levels() const { return levels_; }
  [[nodiscard]] int columns(int level) const { return cellColumns() >> (levels_ - 1 - level); }
  [[nodiscard]] int rows(int level) const { return cellRows() >> (levels_ - 1 - level); }
  [[nodiscard]] int cellColumns() const { return static_cast<int>(x_.size()) - 1; }
  [[nodiscard]] int cellRows() const { return static_cast<int>(y_.size()) - 1; }

  /// First pixel column of cell column `i`, i in [0, cellColumns()]; likewise rows.
  [[nodiscard]] int cellX(int i) const { return x_[static_cast<std::size_t>(i)]; }
  [[nodiscard]] int cellY(int i) const { return y_[static_cast<std::size_t>(i)]; }
  /// Cells along one side of a node of `level`.
  [[nodiscard]] int cellsPerSide(int level) const { return 1 << (levels_ - 1 - level); }

  /// The node's pixels; of area 0 when it lies beyond the border.
  [[nodiscard]] TileRect rect(const QuadtreeNode& node) const {
    const int cells = cellsPerSide(node.level);
    const int x = cellX(node.column * cells);
    const int y = cellY(node.row * cells);
    return {x, y, cellX((node.column + 1) * cells) - x, cellY((node.row + 1) * cells) - y};
  }
  /// The coarsest node with exactly these pixels.
  [[nodiscard]] std::optional<QuadtreeNode> find(const TileRect& rect) const;

 private:
  QuadtreeLayout layout_;
  int levels_ = 1;
  std::vector<int> x_;  // cell boundaries, clipped to the image
  std::vector<int> y_;
  std::vector<int> cell_at_x_;  // of each pixel column: the cell that begins there, -1: none
  std::vector<int> cell_at_y_;
};

}  // namespace planecloud

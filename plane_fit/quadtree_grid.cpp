// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/plane_fit/quadtree_grid.h"

#include <algorithm>

#include "planecloud_slam/plane_fit/option_fields.h"

namespace planecloud {
namespace {

int ceilHalf(int side) { return (side + 1) / 2; }

int countLevels(const QuadtreeLayout& layout) {
  int levels = 1;
  int width = layout.initial_width;
  int height = layout.initial_height;
  while (ceilHalf(width) >= layout.min_tile && ceilHalf(height) >= layout.min_tile) {
    width = ceilHalf(width);
    height = ceilHalf(height);
    ++levels;
  }
  return levels;
}

/// Boundaries of the cells along one side of the image, the last one at `length`.
std::vector<int> cellBoundaries(int initial, int levels, int length) {
  std::vector<int> sides{initial};
  for (int level = 1; level < levels; ++level) {
    std::vector<int> halves;
    for (const int side : sides) {
      halves.push_back(ceilHalf(side));
      halves.push_back(side / 2);
    }
    sides = std::move(halves);
  }
  std::vector<int> boundaries{0};
  for (int root = 0; root * initial < length; ++root) {
    int end = root * initial;
    for (const int side : sides) {
      end += side;
      boundaries.push_back(std::min(end, length));
    }
  }
  return boundaries;
}

/// For each pixel the index of the cell that begins there, -1 if none does; of cells beyond the
/// border, which all begin at the end, none.
std::vector<int> cellsAt(const std::vector<int>& boundaries) {
  std::vector<int> cells(static_cast<std::size_t>(boundaries.back()), -1);
  for (std::size_t i = boundaries.size(); i-- > 0;) {
    const auto begin = static_cast<std::size_t>(boundaries[i]);
    if (begin < cells.size()) cells[begin] = static_cast<int>(i);
  }
  return cells;
}

}  // namespace

QuadtreeGrid::QuadtreeGrid(const QuadtreeLayout& layout, int width, int height) : layout_(layout) {
  checkRange("plane_fit/initial_tile_width", layout.initial_width, 2, 80);
  checkRange("plane_fit/initial_tile_height", layout.initial_height, 2, 80);
  const int initial = std::min(layout.initial_width, layout.initial_height);
  checkRange("plane_fit/min_tile", layout.min_tile, 2, std::min(initial, 64));
  levels_ = countLevels(layout);
  x_ = cellBoundaries(layout.initial_width, levels_, width);
  y_ = cellBoundaries(layout.initial_height, levels_, height);
  cell_at_x_ = cellsAt(x_);
  cell_at_y_ = cellsAt(y_);
}

std::optional<QuadtreeNode> QuadtreeGrid::find(const TileRect& rect) const {
  const bool inside = rect.x >= 0 && rect.x < width() && rect.y >= 0 && rect.y < height();
  if (!inside || rect.area() == 0) return std::nullopt;
  const int column = cell_at_x_[static_cast<std::size_t>(rect.x)];
  const int row = cell_at_y_[static_cast<std::size_t>(rect.y)];
  if (column < 0 || row < 0) return std::nullopt;
  for (int level = 0; level < levels_; ++level) {
    const int shift = levels_ - 1 - level;
    const QuadtreeNode node{level, column >> shift, row >> shift};
    if (this->rect(node) == rect) return node;
  }
  return std::nullopt;
}

}  // namespace planecloud

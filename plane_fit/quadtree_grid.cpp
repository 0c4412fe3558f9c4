// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/plane_fit/quadtree_grid.h"

#include <algorithm>

#include "planecloud_slam/plane_fit/option_fields.h"

namespace planecloud_slam {
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

/// The coarsest level at which [begin, end) is one node's side: first boundary index and level.
struct Side {
  int level;
  int index;
};
std::vector<Side> findSide(const std::vector<int>& boundaries, int levels, int begin, int end) {
  std::vector<Side> found;
  const auto first = std::lower_bound(boundaries.begin(), boundaries.end(), begin);
  if (first == boundaries.end() || *first != begin || end <= begin) return found;
  const int cell = static_cast<int>(first - boundaries.begin());
  for (int level = 0; level < levels; ++level) {
    const int cells = 1 << (levels - 1 - level);
    if (cell % cells == 0 && boundaries[static_cast<std::size_t>(cell + cells)] == end) {
      found.push_back({level, cell / cells});
    }
  }
  return found;
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
}

TileRect QuadtreeGrid::rect(const QuadtreeNode& node) const {
  const int cells = cellsPerSide(node.level);
  const int x = cellX(node.column * cells);
  const int y = cellY(node.row * cells);
  return {x, y, cellX((node.column + 1) * cells) - x, cellY((node.row + 1) * cells) - y};
}

std::optional<QuadtreeNode> QuadtreeGrid::find(const TileRect& rect) const {
  const std::vector<Side> columns = findSide(x_, levels_, rect.x, rect.x + rect.width);
  const std::vector<Side> rows = findSide(y_, levels_, rect.y, rect.y + rect.height);
  for (const Side& column : columns) {
    for (const Side& row : rows) {
      if (column.level == row.level) return QuadtreeNode{column.level, column.index, row.index};
    }
  }
  return std::nullopt;
}

}  // namespace planecloud_slam

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

/// Index of the cell that begins at `begin`, -1 if none does.
int cellAt(const std::vector<int>& boundaries, int begin) {
  const auto first = std::lower_bound(boundaries.begin(), boundaries.end() - 1, begin);
  if (first == boundaries.end() - 1 || *first != begin) return -1;
  return static_cast<int>(first - boundaries.begin());
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
  const int column = cellAt(x_, rect.x);
  const int row = cellAt(y_, rect.y);
  if (column < 0 || row < 0 || rect.area() == 0) return std::nullopt;
  for (int level = 0; level < levels_; ++level) {
    const int cells = cellsPerSide(level);
    const QuadtreeNode node{level, column / cells, row / cells};
    if (this->rect(node) == rect) return node;
  }
  return std::nullopt;
}

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/plane_fit/coding_order.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace planecloud {
namespace {

std::string describe(const TileRect& rect) {
  return "tile (" + std::to_string(rect.x) + ", " + std::to_string(rect.y) + ", " +
         std::to_string(rect.width) + "x" + std::to_string(rect.height) + ")";
}

/// Which cells are taken.
class CellOccupancy {
 public:
  explicit CellOccupancy(const QuadtreeGrid& grid)
      : grid_(grid),
        taken_(static_cast<std::size_t>(grid.cellColumns()) *
               static_cast<std::size_t>(grid.cellRows())) {}

  /// Takes the node's cells; false when one of them is already taken.
  bool take(const QuadtreeNode& node) {
    const int side = grid_.cellsPerSide(node.level);
    bool free = true;
    for (int row = node.row * side; row < (node.row + 1) * side; ++row) {
      const std::ptrdiff_t first = std::ptrdiff_t{row} * grid_.cellColumns() + node.column * side;
      for (auto cell = taken_.begin() + first; cell != taken_.begin() + first + side; ++cell) {
        free = free && *cell == 0;
        *cell = 1;
      }
    }
    return free;
  }

 private:
  const QuadtreeGrid& grid_;
  std::vector<std::uint8_t> taken_;
};

}  // namespace

std::uint64_t codingKey(const QuadtreeGrid& grid, const QuadtreeNode& node) {
  const int root_column = node.column >> node.level;
  const int root_row = node.row >> node.level;
  auto key = static_cast<std::uint64_t>(node.level) << 48;
  key |= static_cast<std::uint64_t>(root_row * grid.columns(0) + root_column) << 16;
  for (int bit = 0; bit < node.level; ++bit) {
    key |= static_cast<std::uint64_t>((node.column >> bit) & 1) << (2 * bit);
    key |= static_cast<std::uint64_t>((node.row >> bit) & 1) << (2 * bit + 1);
  }
  return key;
}

std::vector<TileNode> inCodingOrder(const QuadtreeGrid& grid,
                                    const std::vector<PlanarTile>& tiles) {
  CellOccupancy occupancy(grid);
  std::vector<TileNode> ordered;
  ordered.reserve(tiles.size());
  for (const PlanarTile& tile : tiles) {
    const std::optional<QuadtreeNode> node = grid.find(tile.rect);
    if (!node) throw std::invalid_argument(describe(tile.rect) + " is no node of the quadtree");
    if (!occupancy.take(*node)) {
      throw std::invalid_argument(describe(tile.rect) + " overlaps another tile");
    }
    ordered.push_back({codingKey(grid, *node), *node, tile});
  }
  const auto before = [](const TileNode& a, const TileNode& b) { return a.key < b.key; };
  // What the fitter or the decoder made is in order already.
  if (!std::is_sorted(ordered.begin(), ordered.end(), before)) {
    std::sort(ordered.begin(), ordered.end(), before);
  }
  return ordered;
}

}  // namespace planecloud

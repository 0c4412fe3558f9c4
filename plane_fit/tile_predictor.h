// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "planecloud_slam/plane_fit/tile_quantiser.h"

namespace planecloud {

/// What the tiles coded so far say about the next one. Integers only.
class TilePredictor {
 public:
  static constexpr int kMaxNeighbors = 8;

  /// A tile coded before.
  struct Placed {
    TileRect rect;
    QuantisedPlane plane;
  };
  /// The tiles around a node, whose planes are continued to it.
  struct Candidates {
    TileRect node;
    int count = 0;
    std::array<const Placed*, kMaxNeighbors> tiles;
    std::array<std::int32_t, kMaxNeighbors> centers;  ///< of the continued planes
  };

  explicit TilePredictor(const QuadtreeGrid& grid);

  /// From now on `node` is a tile with this plane.
  void place(const QuadtreeNode& node, const QuantisedPlane& plane);

  /// A tile covers the cell left of, above, right of, below the node's middle: bits 0 to 3.
  [[nodiscard]] unsigned coveredSides(const QuadtreeNode& node) const;
  /// Side neighbours come first. Valid until the next `place`.
  [[nodiscard]] Candidates candidates(const QuadtreeNode& node) const;

  /// Median of the candidates' centres; the last centre placed when there is no neighbour.
  [[nodiscard]] std::int32_t predictCenter(const Candidates& candidates) const;
  /// Largest minus smallest of the candidates' centres, -1 for fewer than two.
  [[nodiscard]] std::int32_t spread(const Candidates& candidates) const;
  /// Slopes of the candidate that comes nearest to `center`; flat when there is none.
  [[nodiscard]] QuantisedPlane predictSlopes(const Candidates& candidates,
                                             std::int32_t center) const;

 private:
  /// The tile over a cell, which may lie one beyond the border.
  [[nodiscard]] const Placed* at(int cell_column, int cell_row) const {
    const std::int32_t owner = owner_[cell(cell_column, cell_row)];
    return owner < 0 ? nullptr : &placed_[static_cast<std::size_t>(owner)];
  }
  [[nodiscard]] std::size_t cell(int column, int row) const {
    return static_cast<std::size_t>((row + 1) * stride_ + column + 1);
  }

  const QuadtreeGrid& grid_;
  int stride_;
  std::vector<std::int32_t> owner_;  // of each cell and a rim: index into placed_, -1: none
  std::vector<Placed> placed_;
};

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/plane_fit/tile_predictor.h"

#include <algorithm>
#include <cstdlib>

namespace planecloud {
namespace {

/// Nearest integer of numerator / denominator (> 0), half away from zero, within
/// +-QuantisedPlane::kMax.
std::int32_t divideRounding(std::int64_t numerator, std::int64_t denominator) {
  const std::int64_t magnitude = (2 * std::abs(numerator) + denominator) / (2 * denominator);
  const std::int64_t clamped = std::min<std::int64_t>(magnitude, QuantisedPlane::kMax);
  return static_cast<std::int32_t>(numerator < 0 ? -clamped : clamped);
}

/// `plane` over `from` as a plane over `to`. Pixels stand for tangents: lenses bend little between
/// neighbours. Positions are in half pixels, in which a side of w pixels is w from the centre.
QuantisedPlane continueTo(const TileRect& to, const TileRect& from, const QuantisedPlane& plane) {
  const std::int64_t dx = 2 * to.x + to.width - 2 * from.x - from.width;
  const std::int64_t dy = 2 * to.y + to.height - 2 * from.y - from.height;
  const std::int64_t w = from.width;
  const std::int64_t h = from.height;
  QuantisedPlane result;
  result.center =
      divideRounding(plane.center * w * h + plane.right * dx * h + plane.down * dy * w, w * h);
  result.right = divideRounding(std::int64_t{plane.right} * to.width, w);
  result.down = divideRounding(std::int64_t{plane.down} * to.height, h);
  return result;
}

}  // namespace

TilePredictor::TilePredictor(const QuadtreeGrid& grid)
    : grid_(grid),
      owner_(
          static_cast<std::size_t>(grid.cellColumns()) * static_cast<std::size_t>(grid.cellRows()),
          -1) {}

void TilePredictor::place(const QuadtreeNode& node, const QuantisedPlane& plane) {
  const int side = grid_.cellsPerSide(node.level);
  const auto index = static_cast<std::int32_t>(placed_.size());
  for (int row = node.row * side; row < (node.row + 1) * side; ++row) {
    const std::ptrdiff_t first = std::ptrdiff_t{row} * grid_.cellColumns() + node.column * side;
    std::fill_n(owner_.begin() + first, side, index);
  }
  placed_.push_back({grid_.rect(node), plane});
}

const TilePredictor::Placed* TilePredictor::at(int column, int row) const {
  if (column < 0 || row < 0 || column >= grid_.cellColumns() || row >= grid_.cellRows()) {
    return nullptr;
  }
  const std::size_t cell =
      static_cast<std::size_t>(row) * static_cast<std::size_t>(grid_.cellColumns()) +
      static_cast<std::size_t>(column);
  const std::int32_t owner = owner_[cell];
  return owner < 0 ? nullptr : &placed_[static_cast<std::size_t>(owner)];
}

unsigned TilePredictor::coveredSides(const QuadtreeNode& node) const {
  const int side = grid_.cellsPerSide(node.level);
  const int x = node.column * side;
  const int y = node.row * side;
  return (at(x - 1, y + side / 2) ? 1U : 0U) | (at(x + side / 2, y - 1) ? 2U : 0U) |
         (at(x + side, y + side / 2) ? 4U : 0U) | (at(x + side / 2, y + side) ? 8U : 0U);
}

TilePredictor::Candidates TilePredictor::candidates(const QuadtreeNode& node) const {
  const int side = grid_.cellsPerSide(node.level);
  const int x = node.column * side;
  const int y = node.row * side;
  const TileRect rect = grid_.rect(node);
  const Placed* const around[kMaxNeighbors] = {
      at(x - 1, y + side / 2),    at(x + side / 2, y - 1), at(x + side, y + side / 2),
      at(x + side / 2, y + side), at(x - 1, y - 1),        at(x + side, y - 1),
      at(x - 1, y + side),        at(x + side, y + side)};
  Candidates candidates;
  for (const Placed* neighbor : around) {
    if (neighbor == nullptr) continue;
    candidates.planes[static_cast<std::size_t>(candidates.count++)] =
        continueTo(rect, neighbor->rect, neighbor->plane);
  }
  return candidates;
}

std::int32_t TilePredictor::predictCenter(const Candidates& candidates) const {
  if (candidates.count == 0) return placed_.empty() ? 0 : placed_.back().plane.center;
  std::array<std::int32_t, kMaxNeighbors> centers{};
  auto end = centers.begin();
  for (int i = 0; i < candidates.count; ++i, ++end) {
    const std::int32_t center = candidates.planes[static_cast<std::size_t>(i)].center;
    const auto place = std::upper_bound(centers.begin(), end, center);
    std::move_backward(place, end, end + 1);
    *place = center;
  }
  const auto upper = static_cast<std::size_t>(candidates.count / 2);
  const auto lower = static_cast<std::size_t>((candidates.count - 1) / 2);
  return std::max(0, (centers[lower] + centers[upper]) / 2);
}

std::int32_t TilePredictor::spread(const Candidates& candidates) const {
  if (candidates.count < 2) return -1;
  std::int32_t low = candidates.planes[0].center;
  std::int32_t high = low;
  for (int i = 1; i < candidates.count; ++i) {
    const std::int32_t center = candidates.planes[static_cast<std::size_t>(i)].center;
    low = std::min(low, center);
    high = std::max(high, center);
  }
  return high - low;
}

QuantisedPlane TilePredictor::predictSlopes(const Candidates& candidates,
                                            std::int32_t center) const {
  QuantisedPlane best;
  std::int32_t nearest = -1;
  for (int i = 0; i < candidates.count; ++i) {
    const QuantisedPlane& plane = candidates.planes[static_cast<std::size_t>(i)];
    const std::int32_t distance = std::abs(plane.center - center);
    if (nearest >= 0 && distance >= nearest) continue;
    nearest = distance;
    best = plane;
  }
  return best;
}

}  // namespace planecloud

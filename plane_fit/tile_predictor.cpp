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

/// The centre of a tile's plane continued to `to`. Pixels stand for tangents: lenses bend little
/// between neighbours. Positions are in half pixels, in which a side of w pixels is w from the
/// centre.
std::int32_t continueCenter(const TileRect& to, const TilePredictor::Placed& tile) {
  const TileRect& from = tile.rect;
  const std::int64_t dx = 2 * to.x + to.width - 2 * from.x - from.width;
  const std::int64_t dy = 2 * to.y + to.height - 2 * from.y - from.height;
  const std::int64_t w = from.width;
  const std::int64_t h = from.height;
  return divideRounding(
      tile.plane.center * w * h + tile.plane.right * dx * h + tile.plane.down * dy * w, w * h);
}

}  // namespace

TilePredictor::TilePredictor(const QuadtreeGrid& grid)
    : grid_(grid),
      stride_(grid.cellColumns() + 2),
      owner_(static_cast<std::size_t>(stride_) * static_cast<std::size_t>(grid.cellRows() + 2),
             -1) {}

void TilePredictor::place(const QuadtreeNode& node, const QuantisedPlane& plane) {
  const int side = grid_.cellsPerSide(node.level);
  const auto index = static_cast<std::int32_t>(placed_.size());
  for (int row = node.row * side; row < (node.row + 1) * side; ++row) {
    std::fill_n(&owner_[cell(node.column * side, row)], side, index);
  }
  placed_.push_back({grid_.rect(node), plane});
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
  const Placed* const around[kMaxNeighbors] = {
      at(x - 1, y + side / 2),    at(x + side / 2, y - 1), at(x + side, y + side / 2),
      at(x + side / 2, y + side), at(x - 1, y - 1),        at(x + side, y - 1),
      at(x - 1, y + side),        at(x + side, y + side)};
  Candidates candidates;
  candidates.node = grid_.rect(node);
  for (const Placed* neighbor : around) {
    if (neighbor == nullptr) continue;
    const auto i = static_cast<std::size_t>(candidates.count++);
    candidates.tiles[i] = neighbor;
    candidates.centers[i] = continueCenter(candidates.node, *neighbor);
  }
  return candidates;
}

std::int32_t TilePredictor::predictCenter(const Candidates& candidates) const {
  if (candidates.count == 0) return placed_.empty() ? 0 : placed_.back().plane.center;
  std::array<std::int32_t, kMaxNeighbors> centers{};
  auto end = centers.begin();
  for (int i = 0; i < candidates.count; ++i, ++end) {
    const std::int32_t center = candidates.centers[static_cast<std::size_t>(i)];
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
  std::int32_t low = candidates.centers[0];
  std::int32_t high = low;
  for (int i = 1; i < candidates.count; ++i) {
    const std::int32_t center = candidates.centers[static_cast<std::size_t>(i)];
    low = std::min(low, center);
    high = std::max(high, center);
  }
  return high - low;
}

QuantisedPlane TilePredictor::predictSlopes(const Candidates& candidates,
                                            std::int32_t center) const {
  const Placed* best = nullptr;
  QuantisedPlane plane;
  for (int i = 0; i < candidates.count; ++i) {
    const std::int32_t candidate = candidates.centers[static_cast<std::size_t>(i)];
    if (best != nullptr && std::abs(candidate - center) >= std::abs(plane.center - center))
      continue;
    best = candidates.tiles[static_cast<std::size_t>(i)];
    plane.center = candidate;
  }
  if (best == nullptr) return {};
  plane.right =
      divideRounding(std::int64_t{best->plane.right} * candidates.node.width, best->rect.width);
  plane.down =
      divideRounding(std::int64_t{best->plane.down} * candidates.node.height, best->rect.height);
  return plane;
}

}  // namespace planecloud

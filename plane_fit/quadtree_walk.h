// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "planecloud_slam/plane_fit/integer_model.h"
#include "planecloud_slam/plane_fit/range_coder.h"
#include "planecloud_slam/plane_fit/tile_predictor.h"

/// The body of a COMPACT stream, one routine for both directions: `Coder` is a `RangeEncoder` or a
/// `RangeDecoder`, `Plan` a `CodingPlan` or `NoPlan`.
namespace planecloud {

inline constexpr std::size_t kMaxQuadtreeLevels = 8;  // 80 px down to 2 px
inline constexpr std::size_t kSpreadClasses = 10;
inline constexpr std::size_t kSlopeClasses = 8;

/// A node's plane in integers; the walk's input when encoding, its result when decoding.
struct CodedTile {
  QuadtreeNode node;
  QuantisedPlane plane;
};

/// Bit length, at most `limit`.
inline std::size_t magnitudeClass(std::int32_t value, std::size_t limit) {
  std::size_t bits = 0;
  for (auto rest = static_cast<std::uint32_t>(std::abs(value)); rest != 0; rest >>= 1) ++bits;
  return std::min(bits, limit);
}

/// Everything that is learnt while a stream is coded. Both directions share it.
struct PlaneModels {
  std::array<std::array<AdaptiveBit, 16>, kMaxQuadtreeLevels> leaf;
  std::array<std::array<AdaptiveBit, 16>, kMaxQuadtreeLevels> split;
  std::array<std::array<IntegerModel, kSpreadClasses + 1>, 2> center;
  std::array<IntegerModel, kSlopeClasses + 1> right;
  std::array<IntegerModel, kSlopeClasses + 1> down;
};

/// Codes one plane less its prediction, in steps of its level.
class PlaneModel {
 public:
  PlaneModel(const QuadtreeGrid& grid, const TileQuantiser& quantiser)
      : grid_(grid), quantiser_(quantiser), predictor_(grid) {}

  template <typename Coder>
  bool codeLeaf(Coder& coder, const QuadtreeNode& node, bool leaf) {
    return coder.code(leaf, models_.leaf[levelClass(node)][predictor_.coveredSides(node)]);
  }
  template <typename Coder>
  bool codeSplit(Coder& coder, const QuadtreeNode& node, bool split) {
    return coder.code(split, models_.split[levelClass(node)][predictor_.coveredSides(node)]);
  }

  template <typename Coder>
  QuantisedPlane codePlane(Coder& coder, const QuadtreeNode& node, QuantisedPlane plane) {
    const int bits = quantiser_.stepBits(node.level);
    const TilePredictor::Candidates candidates = predictor_.candidates(node);
    const std::int32_t spread = predictor_.spread(candidates);
    const std::size_t spread_class =
        spread < 0 ? kSpreadClasses : magnitudeClass(spread >> bits, kSpreadClasses - 1);
    IntegerModel& center_model = models_.center[bits == TileQuantiser::kUnitBits][spread_class];
    std::int32_t residual = 0;
    plane.center = codeInteger(coder, center_model, predictor_.predictCenter(candidates),
                               plane.center, bits, residual);
    const QuantisedPlane slopes = predictor_.predictSlopes(candidates, plane.center);
    const std::size_t center_class =
        candidates.count == 0
            ? kSlopeClasses
            : magnitudeClass((slopes.center - plane.center) >> bits, kSlopeClasses - 1);
    plane.right = codeInteger(coder, models_.right[center_class], slopes.right, plane.right,
                              bits + 1, residual);
    const std::size_t right_class =
        candidates.count == 0 ? kSlopeClasses : magnitudeClass(residual, kSlopeClasses - 1);
    plane.down =
        codeInteger(coder, models_.down[right_class], slopes.down, plane.down, bits + 1, residual);
    predictor_.place(node, plane);
    return plane;
  }

 private:
  [[nodiscard]] std::size_t levelClass(const QuadtreeNode& node) const {
    return static_cast<std::size_t>(grid_.levels() - 1 - node.level);
  }

  /// Codes `value`, a multiple of 2^bits, as its distance in steps from the rounded prediction.
  template <typename Coder>
  static std::int32_t codeInteger(Coder& coder, IntegerModel& model, std::int32_t prediction,
                                  std::int32_t value, int bits, std::int32_t& residual) {
    const std::int32_t step = 1 << bits;
    const std::int32_t half = step / 2;
    const std::int32_t predicted_steps = (prediction + (prediction < 0 ? -half : half)) / step;
    residual = model.code(coder, value / step - predicted_steps);
    // Only a corrupt stream reaches the limits; the quantiser refuses such planes.
    const std::int64_t result = (std::int64_t{predicted_steps} + residual) * step;
    return static_cast<std::int32_t>(
        std::clamp<std::int64_t>(result, -QuantisedPlane::kMax, QuantisedPlane::kMax));
  }

  const QuadtreeGrid& grid_;
  const TileQuantiser& quantiser_;
  TilePredictor predictor_;
  PlaneModels models_;
};

/// What the encoder knows beforehand of every node.
class CodingPlan {
 public:
  CodingPlan(const QuadtreeGrid& grid, const std::vector<CodedTile>& tiles) : tiles_(tiles) {
    for (int level = 0; level < grid.levels(); ++level) {
      columns_.push_back(static_cast<std::size_t>(grid.columns(level)));
      const std::size_t nodes = columns_.back() * static_cast<std::size_t>(grid.rows(level));
      is_ancestor_.emplace_back(nodes, std::uint8_t{0});
    }
    for (const CodedTile& tile : tiles) {
      QuadtreeNode node = tile.node;
      while (node.level > 0) {
        node = {node.level - 1, node.column / 2, node.row / 2};
        is_ancestor_[static_cast<std::size_t>(node.level)][index(node)] = 1;
      }
    }
  }
  /// Nodes are asked in coding order, so only the next tile can be it.
  [[nodiscard]] bool isLeaf(const QuadtreeNode& node, std::size_t next) const {
    return tiles_[next].node == node;
  }
  [[nodiscard]] bool isSplit(const QuadtreeNode& node) const {
    return is_ancestor_[static_cast<std::size_t>(node.level)][index(node)] != 0;
  }
  [[nodiscard]] const QuantisedPlane& plane(std::size_t next) const { return tiles_[next].plane; }

 private:
  [[nodiscard]] std::size_t index(const QuadtreeNode& node) const {
    return static_cast<std::size_t>(node.row) * columns_[static_cast<std::size_t>(node.level)] +
           static_cast<std::size_t>(node.column);
  }
  const std::vector<CodedTile>& tiles_;
  std::vector<std::size_t> columns_;
  std::vector<std::vector<std::uint8_t>> is_ancestor_;
};

/// The decoder's answer to every question: whatever the stream says.
struct NoPlan {
  [[nodiscard]] static bool isLeaf(const QuadtreeNode& /*node*/, std::size_t /*next*/) {
    return false;
  }
  [[nodiscard]] static bool isSplit(const QuadtreeNode& /*node*/) { return false; }
  [[nodiscard]] static QuantisedPlane plane(std::size_t /*next*/) { return {}; }
};

/// Walks the quadtrees breadth first until `count` tiles are coded and hands each to `visit`.
/// Returns how many it found.
template <typename Coder, typename Plan, typename Visit>
std::size_t walkQuadtrees(const QuadtreeGrid& grid, const TileQuantiser& quantiser,
                          std::size_t count, Coder& coder, const Plan& plan, Visit&& visit) {
  PlaneModel model(grid, quantiser);
  std::vector<QuadtreeNode> queue;
  for (int row = 0; row < grid.rows(0); ++row) {
    for (int column = 0; column < grid.columns(0); ++column) queue.push_back({0, column, row});
  }
  std::size_t coded = 0;
  std::vector<QuadtreeNode> next;
  for (int level = 0; level < grid.levels(); ++level) {
    next.clear();
    for (const QuadtreeNode& node : queue) {
      if (coded == count) return coded;
      if (grid.rect(node).area() == 0) continue;
      if (model.codeLeaf(coder, node, plan.isLeaf(node, coded))) {
        visit(CodedTile{node, model.codePlane(coder, node, plan.plane(coded))});
        ++coded;
      } else if (level + 1 < grid.levels() && model.codeSplit(coder, node, plan.isSplit(node))) {
        const int column = 2 * node.column;
        const int row = 2 * node.row;
        next.insert(next.end(), {{level + 1, column, row},
                                 {level + 1, column + 1, row},
                                 {level + 1, column, row + 1},
                                 {level + 1, column + 1, row + 1}});
      }
    }
    queue.swap(next);
  }
  return coded;
}

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "planecloud_slam/plane_fit/moment_pyramid.h"
#include "planecloud_slam/plane_fit/position_regression.h"

namespace planecloud {
namespace {

/// Where errors are only reported, one row in so many is looked at or fewer, at most so many rows,
/// and of wide ones only a part: what costs is memory.
constexpr int kMinRowStep = 4;
constexpr int kMostSampledRows = 2;
constexpr int kSampledColumns = 16;

}  // namespace

int MomentPyramid::countChildren(const QuadtreeNode& node) const {
  if (node.level + 1 == grid_.levels()) return 0;
  const QuadtreeNode last{node.level + 1, 2 * node.column + 1, 2 * node.row + 1};
  if (isFull(node) && grid_.rect(last).area() > 0) return 4;
  int count = 0;
  for (const int row : {2 * node.row, 2 * node.row + 1}) {
    for (const int column : {2 * node.column, 2 * node.column + 1}) {
      const QuadtreeNode child{node.level + 1, column, row};
      bool has_depth = false;
      if (child.level <= block_level_) {
        has_depth = level(child).fills[index(child)] != Fill::kNothing;
      } else if (node.level == block_level_ && isWholeBlock(index(node))) {
        has_depth = quarterHasDepth(index(node), 2 * (row & 1) + (column & 1));
      } else {
        const TileRect rect = grid_.rect(child);
        has_depth = isFull(node) ? rect.area() > 0 : hasDepth(rect);
      }
      count += has_depth ? 1 : 0;
    }
  }
  return count;
}

NodePlane MomentPyramid::regressSmall(const QuadtreeNode& node) const {
  const bool is_listed = !small_blocks_ || !isFull(node);
  if (node.level == block_level_ && is_listed) return level(node).planes[index(node)];
  return regressPositions(sumPositions(node), level(node).depth[index(node)], localTangents(node),
                          grid_.rect(node));
}

PositionSums MomentPyramid::sumPositions(const QuadtreeNode& node) const {
  const TileRect rect = grid_.rect(node);
  if (isFull(node)) return allPositions(rect);
  return std::visit(
      [&](const auto& depth) {
        const auto pixels = block(depth, rect);
        return kernelsFor(pixels).sum_positions(pixels);
      },
      depth_);
}

LocalTangents MomentPyramid::localTangents(const QuadtreeNode& node) const {
  const int deeper = node.level - block_level_;
  const QuadtreeNode in{block_level_, node.column >> deeper, node.row >> deeper};
  const LocalTangents tangents = tables_.finest().at(index(in));
  if (deeper == 0) return tangents;
  const TileRect rect = grid_.rect(node);
  const TileRect block_rect = grid_.rect(in);
  return tangents.about(rect.x - block_rect.x, rect.y - block_rect.y);
}

TangentSums MomentPyramid::sumTangents(const QuadtreeNode& node) const {
  if (node.level > block_level_) {
    return planecloud::sumTangents(sumPositions(node), localTangents(node));
  }
  return isFull(node) ? tables_.level(node.level).sums[index(node)]
                      : level(node).tangents[index(node)];
}

bool MomentPyramid::hasDepthAtCorners(const QuadtreeNode& node, int window) const {
  const TileRect rect = grid_.rect(node);
  const bool fits = window <= std::min(first_block_.width, first_block_.height);
  const bool is_quarter = 2 * window == first_block_.width && 2 * window == first_block_.height;
  // Of the node in blocks.
  const int side = node.level > block_level_ ? 0 : 1 << (block_level_ - node.level);
  for (const int lower : {0, 1}) {
    for (const int right : {0, 1}) {
      if (side > 0) {
        const std::size_t i = index({block_level_, (node.column + right) * side - right,
                                     (node.row + lower) * side - lower});
        if (blocks().fills[i] == Fill::kAll) continue;
        if (isWholeBlock(i)) {
          if (is_quarter && quarterHasDepth(i, 2 * lower + right)) continue;
          if (is_quarter || (fits && blocks().fills[i] == Fill::kNothing)) return false;
        }
      }
      if (!hasDepth({rect.x + right * (rect.width - window),
                     rect.y + lower * (rect.height - window), window, window})) {
        return false;
      }
    }
  }
  return true;
}

TileMoments MomentPyramid::moments(const QuadtreeNode& node) const {
  const bool has_depth = count(node) > 0;
  return moments(node.level, index(node), has_depth ? sumTangents(node) : TangentSums{});
}

TileMoments MomentPyramid::moments(int level, std::size_t i, const TangentSums& tangents) const {
  const Level& nodes = levels_[static_cast<std::size_t>(level)];
  TileMoments moments = tangentMoments(nodes.counts[i], tangents);
  moments.q = nodes.depth[i].q;
  moments.qu = nodes.depth[i].qu;
  moments.qv = nodes.depth[i].qv;
  moments.qq = nodes.depth[i].qq;
  return moments;
}

bool MomentPyramid::hasDepth(const TileRect& rect) const {
  const auto look = [&](const auto& depth) {
    for (int y = rect.y; y < rect.y + rect.height; ++y) {
      for (int x = rect.x; x < rect.x + rect.width; ++x) {
        if (inverse(depth(x, y)) > 0.0F) return true;
      }
    }
    return false;
  };
  return std::visit(look, depth_);
}

ResidualSums MomentPyramid::residuals(const TileRect& rect, const NodePlane& plane) const {
  return std::visit(
      [&](const auto& depth) {
        const auto pixels = block(depth, rect);
        return kernelsFor(pixels).residuals(pixels, tables_.from(rect.x, rect.y), plane);
      },
      depth_);
}

ResidualSums MomentPyramid::sampleResiduals(const QuadtreeNode& node,
                                            const NodePlane& plane) const {
  // A plane fits better at the rim than in the middle: nodes take turns in what is looked at.
  const int turn = node.column + 3 * node.row;
  TileRect rect = grid_.rect(node);
  const int area = rect.area();
  const int step = std::max(kMinRowStep, (rect.height + kMostSampledRows - 1) / kMostSampledRows);
  const int first = turn % std::min(step, rect.height);
  rect.y += first;
  rect.height = (rect.height - first + step - 1) / step;
  const int parts = std::max(1, rect.width / kSampledColumns);
  const int part = turn % parts;
  rect.x += part * kSampledColumns;
  rect.width = part + 1 < parts ? kSampledColumns : rect.width - part * kSampledColumns;
  TangentRows tangents = tables_.from(rect.x, rect.y);
  tangents.stride *= step;
  ResidualSums sums = std::visit(
      [&](const auto& depth) {
        auto pixels = block(depth, rect);
        pixels.stride *= step;
        return kernelsFor(pixels).residuals(pixels, tangents, plane);
      },
      depth_);
  const float scale = static_cast<float>(area) / static_cast<float>(rect.area());
  sums.inverse_depth *= scale;
  sums.relative *= scale;
  sums.depth *= scale;
  return sums;
}

}  // namespace planecloud

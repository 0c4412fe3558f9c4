// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/plane_fit/moment_pyramid.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "planecloud_slam/plane_fit/position_regression.h"

namespace planecloud {
namespace {

/// The tangents of a strong lens are within 1e-5 of an affine function over 8 pixels.
constexpr int kMaxAffineSide = 8;

const Camera& required(const std::shared_ptr<const Camera>& camera) {
  if (!camera) throw std::invalid_argument("the plane fitter needs a camera, got none");
  return *camera;
}

bool isAffine(const TileRect& rect) { return std::max(rect.width, rect.height) <= kMaxAffineSide; }

/// The level of the largest nodes in which a lens is affine, or of the cells.
int findBlockLevel(const QuadtreeGrid& grid) {
  int level = 0;
  while (level + 1 < grid.levels() && !isAffine(grid.rect({level, 0, 0}))) ++level;
  return level;
}

}  // namespace

MomentPyramid::MomentPyramid(const std::shared_ptr<const Camera>& camera,
                             const QuadtreeLayout& layout, const TileKernels& kernels,
                             const DistortionRule& rule)
    : kernels_(kernels),
      grid_(layout, required(camera).width(), required(camera).height()),
      block_level_(findBlockLevel(grid_)),
      tables_(*camera, grid_, block_level_),
      rule_(rule),
      first_block_(grid_.rect({block_level_, 0, 0})),
      levels_(static_cast<std::size_t>(grid_.levels())) {
  small_blocks_ = isAffine(first_block_);
  for (int column = 0; column <= grid_.columns(block_level_); ++column) {
    block_edges_.push_back(grid_.cellX(column * grid_.cellsPerSide(block_level_)));
  }
  const auto width = [&](int i) { return grid_.rect({block_level_, i, 0}).width; };
  while (alike_ < grid_.columns(block_level_) && width(alike_) == width(0)) ++alike_;
  for (std::vector<float>* sums : {&columns_n_, &columns_q_, &columns_qy_, &columns_qq_}) {
    sums->resize(static_cast<std::size_t>(std::max(grid_.width(), 2 * kMaxAffineSide)));
  }
  for (int i = 0; i < grid_.levels(); ++i) {
    Level& level = levels_[static_cast<std::size_t>(i)];
    const auto nodes = static_cast<std::size_t>(grid_.columns(i) * grid_.rows(i));
    level.counts.resize(nodes);
    level.depth.resize(nodes);
    level.distortions.resize(nodes);
    level.fills.resize(nodes);
    if (i > block_level_) continue;
    level.tangents.resize(nodes);
    level.planes.resize(nodes);
    if (i == block_level_ && small_blocks_) level.quarters.resize(nodes);
  }
}

bool MomentPyramid::read(ImageView<float> depth, const std::function<bool()>& give_up) {
  return readPixels(depth, give_up);
}

bool MomentPyramid::read(ImageView<std::uint16_t> depth, const std::function<bool()>& give_up) {
  return readPixels(depth, give_up);
}

template <typename Pixel>
bool MomentPyramid::readPixels(ImageView<Pixel> depth, const std::function<bool()>& give_up) {
  depth_ = depth;
  listed_.clear();
  for (int row = 0; row < grid_.rows(block_level_); ++row) {
    if (give_up && give_up()) return false;
    const TileRect first = grid_.rect({block_level_, 0, row});
    if (first.area() == 0) break;  // beyond the border
    kernels_.of<Pixel>().sum_columns(block(depth, {0, first.y, grid_.width(), first.height}),
                                     columns());
    sumBlocks(row);
    sumPixels(depth, row);
  }
  regressListed(block_level_);
  for (int parent = block_level_; parent-- > 0;) merge(parent);
  return true;
}

ColumnSums MomentPyramid::columns() {
  return {columns_n_.data(), columns_q_.data(), columns_qy_.data(), columns_qq_.data()};
}

void MomentPyramid::sumBlocks(int row) {
  Level& blocks = levels_[static_cast<std::size_t>(block_level_)];
  const std::size_t first = index({block_level_, 0, row});
  const CellRow cells{block_edges_.data(), grid_.columns(block_level_), alike_,
                      grid_.rect({block_level_, 0, row}).height, tables_.finest().from(first)};
  kernels_.sum_cells(columns(), cells, rule_,
                     {&blocks.depth[first], &blocks.counts[first], &blocks.fills[first],
                      &blocks.distortions[first]});
}

template <typename Pixel>
void MomentPyramid::sumPixels(ImageView<Pixel> depth, int row) {
  Level& blocks = levels_[static_cast<std::size_t>(block_level_)];
  const PixelKernels<Pixel>& kernels = kernels_.of<Pixel>();
  std::size_t i = index({block_level_, 0, row});
  for (int column = 0; column < grid_.columns(block_level_); ++column, ++i) {
    const bool is_full = blocks.fills[i] == Fill::kAll;
    if ((is_full && small_blocks_) || blocks.fills[i] == Fill::kNothing) continue;
    const TileRect rect = grid_.rect({block_level_, column, row});
    const DepthBlock<Pixel> pixels = block(depth, rect);
    if (small_blocks_) {
      const PositionSums positions = kernels.sum_positions(pixels);
      blocks.quarters[i] = positions.quarters;
      blocks.tangents[i] = planecloud::sumTangents(positions, tables_.finest().at(i));
    } else {
      const BlockSums sums = kernels.sum_block(pixels, tables_.from(rect.x, rect.y));
      blocks.depth[i].qu = sums.qu;
      blocks.depth[i].qv = sums.qv;
      blocks.tangents[i] = is_full ? tables_.level(block_level_).sums[i] : sums.tangents;
    }
    listed_.add(i, moments(block_level_, i, blocks.tangents[i]));
  }
}

void MomentPyramid::split(const QuadtreeNode& node) {
  if (node.level < block_level_) return;
  std::visit([&](const auto& depth) { splitPixels(depth, node); }, depth_);
}

template <typename Pixel>
void MomentPyramid::splitPixels(ImageView<Pixel> depth, const QuadtreeNode& node) {
  const TileRect rect = grid_.rect(node);
  const QuadtreeNode first_child{node.level + 1, 2 * node.column, 2 * node.row};
  const TileRect corner = grid_.rect(first_child);
  const std::array<int, 2> widths = {corner.width, rect.width - corner.width};
  const std::array<int, 2> heights = {corner.height, rect.height - corner.height};
  // As one row of cells: upper left, upper right, lower left, lower right.
  const PixelKernels<Pixel>& kernels = kernels_.of<Pixel>();
  kernels.sum_columns(block(depth, {rect.x, rect.y, rect.width, heights[0]}), columns());
  kernels.sum_columns(block(depth, {rect.x, rect.y + heights[0], rect.width, heights[1]}),
                      columns().from(rect.width));
  const LocalTangents tangents = localTangents(node);
  std::array<int, 5> edges{};
  std::array<std::array<float, 4>, 6> tables;
  for (std::size_t i = 0; i < 4; ++i) {
    edges[i + 1] = edges[i] + widths[i % 2];
    const LocalTangents child =
        tangents.about(i % 2 == 0 ? 0 : widths[0], i / 2 == 0 ? 0 : heights[0]);
    tables[0][i] = child.u;
    tables[1][i] = child.u_right;
    tables[2][i] = child.u_down;
    tables[3][i] = child.v;
    tables[4][i] = child.v_right;
    tables[5][i] = child.v_down;
  }
  std::array<DepthSums, 4> sums;
  std::array<float, 4> counts{}, distortions{};
  std::array<Fill, 4> fills{};
  const std::size_t at_once = heights[0] == heights[1] ? 4 : 2;
  for (std::size_t i = 0; i < 4; i += at_once) {
    const int cells = static_cast<int>(at_once);
    const CellRow row{
        &edges[i],
        cells,
        widths[0] == widths[1] ? cells : 1,
        heights[i / 2],
        {&tables[0][i], &tables[1][i], &tables[2][i], &tables[3][i], &tables[4][i], &tables[5][i]}};
    kernels_.sum_cells(columns(), row, rule_, {&sums[i], &counts[i], &fills[i], &distortions[i]});
  }
  Level& children = levels_[static_cast<std::size_t>(first_child.level)];
  const std::size_t first = index(first_child);
  const auto child_columns = static_cast<std::size_t>(grid_.columns(first_child.level));
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t child = first + i / 2 * child_columns + i % 2;
    children.depth[child] = sums[i];
    children.counts[child] = counts[i];
    children.fills[child] = fills[i];
    children.distortions[child] = fills[i] == Fill::kAll ? distortions[i] : -1.0F;
  }
}

void MomentPyramid::merge(int parent_level) {
  Level& parents = levels_[static_cast<std::size_t>(parent_level)];
  const Level& children = levels_[static_cast<std::size_t>(parent_level) + 1];
  const std::vector<float>& full = tables_.level(parent_level).full.n;
  const auto child_columns = static_cast<std::size_t>(grid_.columns(parent_level + 1));
  listed_.clear();
  std::size_t parent = 0;
  for (std::size_t row = 0; parent < full.size(); row += 2) {
    for (std::size_t column = 0; column < child_columns; column += 2, ++parent) {
      const std::size_t first = row * child_columns + column;
      const std::array<std::size_t, 4> child = {first, first + 1, first + child_columns,
                                                first + child_columns + 1};
      DepthSums sum;
      float n = 0.0F;
      for (const std::size_t c : child) {
        n += children.counts[c];
        sum += children.depth[c];
      }
      parents.depth[parent] = sum;
      parents.counts[parent] = n;
      parents.fills[parent] = fillOf(n, full[parent]);
      if (parents.fills[parent] != Fill::kPart) continue;
      parents.tangents[parent] = mergeTangents(parent_level + 1, child);
      listed_.add(parent, moments(parent_level, parent, parents.tangents[parent]));
    }
  }
  kernels_.regress(parents.depth.data(), tables_.level(parent_level).full.from(0), rule_,
                   full.size(), {parents.planes.data(), parents.distortions.data()});
  regressListed(parent_level);
}

void MomentPyramid::regressListed(int level) {
  Level& nodes = levels_[static_cast<std::size_t>(level)];
  const FullNodes& full = tables_.level(level).full;
  listed_.regress(kernels_);
  for (std::size_t i = 0; i < listed_.size(); ++i) {
    const std::size_t node = listed_.node(i);
    NodePlane plane = listed_.plane(i);
    const float n = nodes.counts[node];
    float distortion = rule_.weigh(n, nodes.depth[node].q, plane.rms);
    const float lowest = plane.alpha * full.mean_u[node] + plane.beta * full.mean_v[node] +
                         plane.gamma - std::abs(plane.alpha) * full.reach_u[node] -
                         std::abs(plane.beta) * full.reach_v[node];
    if (lowest < kMinPlaneInverseDepth) {
      plane.rms = -plane.rms;
      distortion = -1.0F;
    }
    nodes.distortions[node] = distortion;
    nodes.planes[node] = plane;
  }
}

TangentSums MomentPyramid::mergeTangents(int level, const std::array<std::size_t, 4>& nodes) const {
  const Level& children = levels_[static_cast<std::size_t>(level)];
  const std::vector<TangentSums>& full = tables_.level(level).sums;
  TangentSums sums;
  for (const std::size_t node : nodes) {
    if (children.fills[node] == Fill::kNothing) continue;
    sums += children.fills[node] == Fill::kAll ? full[node] : children.tangents[node];
  }
  return sums;
}

}  // namespace planecloud

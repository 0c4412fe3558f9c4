// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/plane_fit/moment_pyramid.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "planecloud_slam/plane_fit/position_regression.h"

namespace planecloud {
namespace {

/// Cells with longer sides are summed pixel by pixel: the tangents of a strong lens are within 1e-5
/// of an affine function over 8 pixels.
constexpr int kMaxAffineSide = 8;
/// Where errors are only reported, one row in so many is looked at or fewer, at most so many rows,
/// and of wide ones only a part: what costs is memory.
constexpr int kMinRowStep = 4;
constexpr int kMostSampledRows = 2;
constexpr int kSampledColumns = 16;

const Camera& required(const std::shared_ptr<const Camera>& camera) {
  if (!camera) throw std::invalid_argument("the plane fitter needs a camera, got none");
  return *camera;
}

}  // namespace

MomentPyramid::MomentPyramid(const std::shared_ptr<const Camera>& camera,
                             const QuadtreeLayout& layout, const TileKernels& kernels,
                             const DistortionRule& rule)
    : kernels_(kernels),
      grid_(layout, required(camera).width(), required(camera).height()),
      tables_(*camera, grid_),
      rule_(rule),
      levels_(static_cast<std::size_t>(grid_.levels())) {
  for (std::vector<float>* sums : {&columns_n_, &columns_q_, &columns_qy_, &columns_qq_}) {
    sums->resize(static_cast<std::size_t>(grid_.width()));
  }
  const TileRect cell = grid_.rect({grid_.levels() - 1, 0, 0});
  small_cells_ = std::max(cell.width, cell.height) <= kMaxAffineSide;
  while (fours_ < grid_.cellColumns() && grid_.cellX(fours_ + 1) == 4 * (fours_ + 1)) ++fours_;
  for (int i = 0; i < grid_.levels(); ++i) {
    Level& level = levels_[static_cast<std::size_t>(i)];
    const std::size_t nodes = tables_.level(i).sums.size();
    level.counts.resize(nodes);
    level.depth.resize(nodes);
    level.tangents.resize(nodes);
    if (i + 1 < grid_.levels()) level.planes.resize(nodes);
    level.distortions.resize(nodes);
    level.fills.resize(nodes);
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
  for (int row = 0; row < grid_.cellRows(); ++row) {
    if (give_up && give_up()) return false;
    const int y = grid_.cellY(row);
    const TileRect strip{0, y, grid_.width(), grid_.cellY(row + 1) - y};
    kernels_.of<Pixel>().sum_columns(block(depth, strip), columns());
    sumCells(row);
    sumPixels(depth, row);
  }
  for (int parent = grid_.levels() - 1; parent-- > 0;) merge(parent);
  return true;
}

ColumnSums MomentPyramid::columns() {
  return {columns_n_.data(), columns_q_.data(), columns_qy_.data(), columns_qq_.data()};
}

void MomentPyramid::sumCells(int row) {
  Level& cells = levels_.back();
  const std::size_t first = index({grid_.levels() - 1, 0, row});
  const int height = grid_.cellY(row + 1) - grid_.cellY(row);
  const CellRow cell_row{grid_.cellEdges(), grid_.cellColumns(), fours_, height,
                         tables_.cells().from(first)};
  kernels_.sum_cells(
      columns(), cell_row, rule_,
      {&cells.depth[first], &cells.counts[first], &cells.fills[first], &cells.distortions[first]});
}

template <typename Pixel>
void MomentPyramid::sumPixels(ImageView<Pixel> depth, int row) {
  const int level = grid_.levels() - 1;
  Level& cells = levels_.back();
  const PixelKernels<Pixel>& kernels = kernels_.of<Pixel>();
  const std::vector<TangentSums>& full_sums = tables_.level(level).sums;
  std::size_t i = index({level, 0, row});
  for (int column = 0; column < grid_.cellColumns(); ++column, ++i) {
    const bool is_full = cells.fills[i] == Fill::kAll;
    if ((is_full && small_cells_) || cells.fills[i] == Fill::kNothing) continue;
    const TileRect rect = grid_.rect({level, column, row});
    const DepthBlock<Pixel> pixels = block(depth, rect);
    if (small_cells_) {
      cells.tangents[i] = sumTangents(kernels.sum_positions(pixels), tables_.cells().from(i));
    } else {
      const BlockSums sums = kernels.sum_block(pixels, tables_.from(rect.x, rect.y));
      cells.depth[i].qu = sums.qu;
      cells.depth[i].qv = sums.qv;
      cells.tangents[i] = is_full ? full_sums[i] : sums.tangents;
    }
    cells.distortions[i] = -1.0F;  // few are ever asked about
  }
}

void MomentPyramid::merge(int parent_level) {
  Level& parents = levels_[static_cast<std::size_t>(parent_level)];
  const Level& children = levels_[static_cast<std::size_t>(parent_level) + 1];
  const std::vector<float>& full = tables_.level(parent_level).full.n;
  const auto child_columns = static_cast<std::size_t>(grid_.columns(parent_level + 1));
  holes_.clear();
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
      holes_.add(parent, moments(parent_level, parent));
    }
  }
  kernels_.regress(parents.depth.data(), tables_.level(parent_level).full.from(0), rule_,
                   full.size(), {parents.planes.data(), parents.distortions.data()});
  regressHoles(parent_level);
}

void MomentPyramid::regressHoles(int level) {
  Level& nodes = levels_[static_cast<std::size_t>(level)];
  const FullNodes& full = tables_.level(level).full;
  holes_.regress(kernels_);
  for (std::size_t i = 0; i < holes_.size(); ++i) {
    const std::size_t node = holes_.node(i);
    NodePlane plane = holes_.plane(i);
    const float n = nodes.counts[node];
    float distortion = rule_.factor * n * plane.rms;
    for (int power = 0; power < rule_.depth_power; ++power) distortion *= n / nodes.depth[node].q;
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

NodePlane MomentPyramid::regressCell(const QuadtreeNode& node) const {
  const std::size_t i = index(node);
  NodePlane plane;
  if (small_cells_) {
    const TileRect rect = grid_.rect(node);
    const PositionSums positions = isFull(node) ? allPositions(rect) : sumPositions(rect);
    plane = regressPositions(positions, levels_.back().depth[i], tables_.cells().from(i), rect);
  } else {
    const TileMoments sums = moments(node);
    const Eigen::Vector3d fit = regressInverseDepth(sums);
    plane.alpha = static_cast<float>(fit.x());
    plane.beta = static_cast<float>(fit.y());
    plane.gamma = static_cast<float>(fit.z());
    plane.rms = -static_cast<float>(rootMeanSquare(sums, fit));
  }
  return plane;
}

PositionSums MomentPyramid::sumPositions(const TileRect& rect) const {
  return std::visit(
      [&](const auto& depth) {
        const auto pixels = block(depth, rect);
        return kernelsFor(pixels).sum_positions(pixels);
      },
      depth_);
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

std::optional<bool> MomentPyramid::hasDepthAtCorners(const QuadtreeNode& node, int window) const {
  const int side = grid_.cellsPerSide(node.level);
  const Level& cells = levels_.back();
  const std::vector<float>& areas = tables_.level(grid_.levels() - 1).full.n;
  const auto window_area = static_cast<float>(window * window);
  for (const int row : {node.row * side, (node.row + 1) * side - 1}) {
    for (const int column : {node.column * side, (node.column + 1) * side - 1}) {
      const std::size_t cell = index({grid_.levels() - 1, column, row});
      if (cells.fills[cell] == Fill::kAll) continue;
      if (areas[cell] != window_area || side == 1) return std::nullopt;
      if (cells.fills[cell] == Fill::kNothing) return false;
    }
  }
  return true;
}

TileMoments MomentPyramid::moments(int level, std::size_t i) const {
  const Level& nodes = levels_[static_cast<std::size_t>(level)];
  TileMoments moments;
  moments.n = nodes.counts[i];
  if (nodes.fills[i] != Fill::kNothing) {
    const bool is_full = nodes.fills[i] == Fill::kAll;
    const TangentSums& tangents = is_full ? tables_.level(level).sums[i] : nodes.tangents[i];
    moments.u = tangents.u;
    moments.v = tangents.v;
    moments.uu = tangents.uu;
    moments.uv = tangents.uv;
    moments.vv = tangents.vv;
  }
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

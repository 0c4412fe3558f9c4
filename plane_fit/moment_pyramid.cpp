// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/plane_fit/moment_pyramid.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <type_traits>
#include <utility>

namespace planecloud {
namespace {

/// Rows of which one is looked at where errors are only reported.
constexpr int kSampledRows = 4;

const Camera& required(const std::shared_ptr<const Camera>& camera) {
  if (!camera) throw std::invalid_argument("the plane fitter needs a camera, got none");
  return *camera;
}

}  // namespace

MomentPyramid::MomentPyramid(const std::shared_ptr<const Camera>& camera,
                             const QuadtreeLayout& layout, const TileKernels& kernels)
    : kernels_(kernels),
      grid_(layout, required(camera).width(), required(camera).height()),
      tables_(*camera, grid_),
      uniform_cells_(layout.initial_width % grid_.cellsPerSide(0) == 0),
      inverse_depth_(tables_.size(), 0.0F) {
  for (std::vector<float>* sums :
       {&columns_n_, &columns_q_, &columns_qu_, &columns_qv_, &columns_qq_}) {
    sums->assign(static_cast<std::size_t>(tables_.stride()), 0.0F);
  }
  levels_.resize(static_cast<std::size_t>(grid_.levels()));
  for (int i = 0; i < grid_.levels(); ++i) {
    Level& level = levels_[static_cast<std::size_t>(i)];
    const std::size_t nodes = tables_.level(i).sums.size();
    level.counts.resize(nodes);
    level.depth.resize(nodes);
    level.tangents.resize(nodes);
    level.planes.resize(nodes);
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
  for (int row = 0; row < grid_.cellRows(); ++row) {
    if (give_up && give_up()) return false;
    sumStrip(depth, row);
    sumCells(row);
    sumHoles(row);
  }
  for (int parent = grid_.levels() - 1; parent-- > 0;) merge(parent);
  return true;
}

template <typename Pixel>
void MomentPyramid::sumStrip(ImageView<Pixel> depth, int row) {
  const int y = grid_.cellY(row);
  DepthStrip<Pixel> strip;
  strip.depth = depth.row(y);
  strip.depth_stride = depth.stride();
  strip.tangents = tables_.from(0, y);
  strip.inverse_depth = &inverse_depth_[tables_.offset(0, y)];
  strip.width = grid_.width();
  strip.rows = grid_.cellY(row + 1) - y;
  const ColumnSums sums{columns_n_.data(), columns_q_.data(), columns_qu_.data(),
                        columns_qv_.data(), columns_qq_.data()};
  if constexpr (std::is_same_v<Pixel, float>) {
    kernels_.sum_columns_f32(strip, sums);
  } else {
    kernels_.sum_columns_u16(strip, sums);
  }
}

void MomentPyramid::sumCells(int row) {
  Level& cells = levels_.back();
  const ColumnSums sums{columns_n_.data(), columns_q_.data(), columns_qu_.data(),
                        columns_qv_.data(), columns_qq_.data()};
  const std::size_t first = index({grid_.levels() - 1, 0, row});
  const int cell_width = grid_.cellX(1);
  const int uniform = uniform_cells_ ? grid_.width() / cell_width : 0;
  kernels_.sum_cells(sums, cell_width, uniform, &cells.depth[first], &cells.counts[first]);
  for (int column = uniform; column < grid_.cellColumns(); ++column) {
    DepthSums sum;
    float n = 0.0F;
    for (auto x = static_cast<std::size_t>(grid_.cellX(column));
         x < static_cast<std::size_t>(grid_.cellX(column + 1)); ++x) {
      n += columns_n_[x];
      sum.q += columns_q_[x];
      sum.qu += columns_qu_[x];
      sum.qv += columns_qv_[x];
      sum.qq += columns_qq_[x];
    }
    cells.depth[first + static_cast<std::size_t>(column)] = sum;
    cells.counts[first + static_cast<std::size_t>(column)] = n;
  }
  kernels_.regress(&cells.depth[first], tables_.level(grid_.levels() - 1).full.from(first),
                   static_cast<std::size_t>(grid_.cellColumns()), &cells.planes[first]);
}

void MomentPyramid::sumHoles(int row) {
  Level& cells = levels_.back();
  const std::vector<float>& full = tables_.level(grid_.levels() - 1).full.n;
  std::size_t i = index({grid_.levels() - 1, 0, row});
  for (int column = 0; column < grid_.cellColumns(); ++column, ++i) {
    if (cells.counts[i] == full[i] || cells.counts[i] == 0.0F) continue;
    cells.tangents[i] =
        kernels_.sum_tangents(pixels(grid_.rect({grid_.levels() - 1, column, row})));
  }
}

void MomentPyramid::merge(int parent_level) {
  Level& parents = levels_[static_cast<std::size_t>(parent_level)];
  const Level& children = levels_[static_cast<std::size_t>(parent_level) + 1];
  const std::vector<float>& full = tables_.level(parent_level).full.n;
  const auto child_columns = static_cast<std::size_t>(grid_.columns(parent_level + 1));
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
      if (n == full[parent] || n == 0.0F) continue;
      parents.tangents[parent] = mergeTangents(parent_level + 1, child);
    }
  }
  kernels_.regress(parents.depth.data(), tables_.level(parent_level).full.from(0), full.size(),
                   parents.planes.data());
}

TangentSums MomentPyramid::mergeTangents(int level, const std::array<std::size_t, 4>& nodes) const {
  const Level& children = levels_[static_cast<std::size_t>(level)];
  const TangentTables::Level& tables = tables_.level(level);
  TangentSums sums;
  for (const std::size_t node : nodes) {
    if (children.counts[node] == 0.0F) continue;
    const bool full = children.counts[node] == tables.full.n[node];
    sums += full ? tables.sums[node] : children.tangents[node];
  }
  return sums;
}

std::optional<bool> MomentPyramid::hasDepthAtCorners(const QuadtreeNode& node, int window) const {
  const int side = grid_.cellsPerSide(node.level);
  const std::vector<float>& counts = levels_.back().counts;
  const std::vector<float>& full = tables_.level(grid_.levels() - 1).full.n;
  const auto window_area = static_cast<float>(window * window);
  for (const int row : {node.row * side, (node.row + 1) * side - 1}) {
    for (const int column : {node.column * side, (node.column + 1) * side - 1}) {
      const std::size_t cell = index({grid_.levels() - 1, column, row});
      const bool is_full = counts[cell] == full[cell] && full[cell] > 0.0F;
      if (is_full) continue;
      if (full[cell] != window_area || side == 1) return std::nullopt;
      if (counts[cell] == 0.0F) return false;
    }
  }
  return true;
}

TileMoments MomentPyramid::moments(const QuadtreeNode& node) const {
  const Level& nodes = level(node);
  const std::size_t i = index(node);
  TileMoments moments;
  moments.n = nodes.counts[i];
  if (moments.n > 0.0) {
    const TangentSums& tangents =
        isFull(node) ? tables_.level(node.level).sums[i] : nodes.tangents[i];
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

NodePlane MomentPyramid::regressWithHoles(const QuadtreeNode& node) const {
  const TileMoments sums = moments(node);
  const Eigen::Vector3d plane = regressInverseDepth(sums);
  // Residuals of a regression are orthogonal to it.
  const double explained = plane.dot(Eigen::Vector3d(sums.qu, sums.qv, sums.q));
  NodePlane result;
  result.alpha = static_cast<float>(plane.x());
  result.beta = static_cast<float>(plane.y());
  result.gamma = static_cast<float>(plane.z());
  const float rms = std::sqrt(static_cast<float>(std::max(0.0, (sums.qq - explained) / sums.n)));
  const FullNodeRows full = tables_.level(node.level).full.from(index(node));
  const float lowest = result.alpha * *full.mean_u + result.beta * *full.mean_v + result.gamma -
                       std::abs(result.alpha) * *full.reach_u -
                       std::abs(result.beta) * *full.reach_v;
  result.rms = lowest >= kMinPlaneInverseDepth ? rms : -rms;
  return result;
}

PixelBlock MomentPyramid::pixels(const TileRect& rect) const {
  return {&inverse_depth_[tables_.offset(rect.x, rect.y)], tables_.from(rect.x, rect.y), rect.width,
          rect.height};
}

ResidualSums MomentPyramid::residuals(const TileRect& rect, const Eigen::Vector3f& plane) const {
  return kernels_.residuals({pixels(rect), plane.x(), plane.y(), plane.z()});
}

ResidualSums MomentPyramid::sampleResiduals(const QuadtreeNode& node,
                                            const Eigen::Vector3f& plane) const {
  const TileRect rect = grid_.rect(node);
  // A plane fits rows at the rim better than those in the middle: neighbours take turns.
  const int first = std::min((node.column + node.row) % 2, rect.height - 1);
  PixelBlock sampled = pixels({rect.x, rect.y + first, rect.width, rect.height - first});
  sampled.rows = (sampled.rows + kSampledRows - 1) / kSampledRows;
  sampled.tangents.stride *= kSampledRows;
  ResidualSums sums = kernels_.residuals({sampled, plane.x(), plane.y(), plane.z()});
  const float scale = static_cast<float>(rect.height) / static_cast<float>(sampled.rows);
  sums.inverse_depth *= scale;
  sums.relative *= scale;
  sums.depth *= scale;
  return sums;
}

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/plane_fit/moment_pyramid.h"

#include <algorithm>
#include <stdexcept>
#include <type_traits>
#include <utility>

namespace planecloud {
namespace {

constexpr std::ptrdiff_t kRowPadding = 16;  // floats a vector kernel may read past a row

std::shared_ptr<const Camera> required(std::shared_ptr<const Camera> camera) {
  if (!camera) throw std::invalid_argument("the plane fitter needs a camera, got none");
  return camera;
}

}  // namespace

MomentPyramid::MomentPyramid(std::shared_ptr<const Camera> camera, const QuadtreeLayout& layout,
                             const TileKernels& kernels)
    : camera_(required(std::move(camera))),
      kernels_(kernels),
      grid_(layout, camera_->width(), camera_->height()),
      stride_((camera_->width() + 2 * kRowPadding - 1) / kRowPadding * kRowPadding),
      uniform_cells_(layout.initial_width % grid_.cellsPerSide(0) == 0) {
  const auto pixels = static_cast<std::size_t>(stride_ * camera_->height() + kRowPadding);
  tangents_u_.assign(pixels, 0.0F);
  tangents_v_.assign(pixels, 0.0F);
  inverse_depth_.assign(pixels, 0.0F);
  for (std::vector<float>* sums :
       {&columns_n_, &columns_q_, &columns_qu_, &columns_qv_, &columns_qq_}) {
    sums->assign(static_cast<std::size_t>(stride_), 0.0F);
  }
  levels_.resize(static_cast<std::size_t>(grid_.levels()));
  for (int i = 0; i < grid_.levels(); ++i) {
    Level& level = levels_[static_cast<std::size_t>(i)];
    level.columns = grid_.columns(i);
    const auto nodes = static_cast<std::size_t>(grid_.columns(i) * grid_.rows(i));
    level.full.resize(nodes);
    level.full_tangents.resize(nodes);
    level.counts.resize(nodes);
    level.depth.resize(nodes);
    level.tangents.resize(nodes);
  }
  tabulateTangents();
  tabulateFullNodes();
}

void MomentPyramid::tabulateTangents() {
  for (int row = 0; row < grid_.rows(0); ++row) {
    for (int column = 0; column < grid_.columns(0); ++column) {
      const TileRect root = grid_.rect({0, column, row});
      const int center_x = root.x + root.width / 2;
      const int center_y = root.y + root.height / 2;
      const Eigen::Vector2f center(camera_->tangentsX()(center_x, center_y),
                                   camera_->tangentsY()(center_x, center_y));
      origins_.push_back(center);
      for (int y = root.y; y < root.y + root.height; ++y) {
        for (int x = root.x; x < root.x + root.width; ++x) {
          tangents_u_[offset(x, y)] = camera_->tangentsX()(x, y) - center.x();
          tangents_v_[offset(x, y)] = camera_->tangentsY()(x, y) - center.y();
        }
      }
    }
  }
}

void MomentPyramid::tabulateFullNodes() {
  for (int row = 0; row < grid_.cellRows(); ++row) {
    for (int column = 0; column < grid_.cellColumns(); ++column) tabulateCell(column, row);
  }
  for (std::size_t parent = levels_.size() - 1; parent-- > 0;) mergeFullNodes(parent);
  for (Level& level : levels_) {
    for (std::size_t i = 0; i < level.full.size(); ++i) {
      if (level.full[i].n > 0.0F) prepareRegression(level.full_tangents[i], level.full[i]);
    }
  }
}

void MomentPyramid::prepareRegression(const TangentSums& sums, FullNode& full) {
  TileMoments moments;
  moments.n = full.n;
  moments.u = sums.u;
  moments.v = sums.v;
  moments.uu = sums.uu;
  moments.uv = sums.uv;
  moments.vv = sums.vv;
  const TangentScatterInverse inverse = invertTangentScatter(moments);
  full.mean_u = sums.u / full.n;
  full.mean_v = sums.v / full.n;
  full.inverse_uu = static_cast<float>(inverse.uu);
  full.inverse_uv = static_cast<float>(inverse.uv);
  full.inverse_vv = static_cast<float>(inverse.vv);
}

void MomentPyramid::tabulateCell(int column, int row) {
  const QuadtreeNode node{grid_.levels() - 1, column, row};
  const TileRect rect = grid_.rect(node);
  TileMoments sums;
  for (int y = rect.y; y < rect.y + rect.height; ++y) {
    for (int x = rect.x; x < rect.x + rect.width; ++x) {
      sums.add(tangents_u_[offset(x, y)], tangents_v_[offset(x, y)], 0.0);
    }
  }
  levels_.back().full[index(node)].n = static_cast<float>(sums.n);
  levels_.back().full_tangents[index(node)] = {
      static_cast<float>(sums.u), static_cast<float>(sums.v), static_cast<float>(sums.uu),
      static_cast<float>(sums.uv), static_cast<float>(sums.vv)};
}

void MomentPyramid::mergeFullNodes(std::size_t parent_level) {
  Level& parents = levels_[parent_level];
  const Level& children = levels_[parent_level + 1];
  for (std::size_t i = 0; i < children.full.size(); ++i) {
    const auto columns = static_cast<std::size_t>(children.columns);
    const std::size_t parent =
        i / columns / 2 * static_cast<std::size_t>(parents.columns) + i % columns / 2;
    parents.full[parent].n += children.full[i].n;
    parents.full_tangents[parent] += children.full_tangents[i];
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
  for (std::size_t parent = levels_.size() - 1; parent-- > 0;) merge(parent);
  return true;
}

template <typename Pixel>
void MomentPyramid::sumStrip(ImageView<Pixel> depth, int row) {
  const int y = grid_.cellY(row);
  DepthStrip<Pixel> strip;
  strip.depth = depth.row(y);
  strip.depth_stride = depth.stride();
  strip.tangents = {&tangents_u_[offset(0, y)], &tangents_v_[offset(0, y)], stride_};
  strip.inverse_depth = &inverse_depth_[offset(0, y)];
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
  for (int column = uniform; column < cells.columns; ++column) {
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
}

void MomentPyramid::sumHoles(int row) {
  Level& cells = levels_.back();
  for (int column = 0; column < cells.columns; ++column) {
    const QuadtreeNode node{grid_.levels() - 1, column, row};
    const std::size_t i = index(node);
    if (cells.counts[i] == cells.full[i].n || cells.counts[i] == 0.0F) continue;
    const TileRect rect = grid_.rect(node);
    TangentSums sums;
    for (int y = rect.y; y < rect.y + rect.height; ++y) {
      for (std::size_t at = offset(rect.x, y); at < offset(rect.x + rect.width, y); ++at) {
        const float mask = inverse_depth_[at] > 0.0F ? 1.0F : 0.0F;
        const float u = mask * tangents_u_[at];
        const float v = mask * tangents_v_[at];
        sums += {u, v, u * u, u * v, v * v};
      }
    }
    cells.tangents[i] = sums;
  }
}

void MomentPyramid::merge(std::size_t parent_level) {
  Level& parents = levels_[parent_level];
  const Level& children = levels_[parent_level + 1];
  const auto child_columns = static_cast<std::size_t>(children.columns);
  for (std::size_t i = 0; i < parents.full.size(); ++i) {
    const auto columns = static_cast<std::size_t>(parents.columns);
    const std::size_t first = i / columns * 2 * child_columns + i % columns * 2;
    const std::array<std::size_t, 4> child = {first, first + 1, first + child_columns,
                                              first + child_columns + 1};
    DepthSums sum;
    float n = 0.0F;
    for (const std::size_t c : child) {
      n += children.counts[c];
      sum += children.depth[c];
    }
    parents.depth[i] = sum;
    parents.counts[i] = n;
    if (n != parents.full[i].n && n != 0.0F) parents.tangents[i] = mergeTangents(children, child);
  }
}

MomentPyramid::TangentSums MomentPyramid::mergeTangents(const Level& level,
                                                        const std::array<std::size_t, 4>& nodes) {
  TangentSums sums;
  for (const std::size_t node : nodes) {
    if (level.counts[node] == 0.0F) continue;
    const bool full = level.counts[node] == level.full[node].n;
    sums += full ? level.full_tangents[node] : level.tangents[node];
  }
  return sums;
}

TileMoments MomentPyramid::moments(const QuadtreeNode& node) const {
  const Level& nodes = level(node);
  const std::size_t i = index(node);
  const bool full = nodes.counts[i] == nodes.full[i].n;
  TileMoments moments;
  moments.n = nodes.counts[i];
  if (moments.n > 0.0) {
    const TangentSums& tangents = full ? nodes.full_tangents[i] : nodes.tangents[i];
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

Eigen::Vector3d MomentPyramid::regress(const QuadtreeNode& node) const {
  const Level& nodes = level(node);
  const std::size_t i = index(node);
  const FullNode& full = nodes.full[i];
  if (nodes.counts[i] != full.n) return regressInverseDepth(moments(node));
  const DepthSums& sums = nodes.depth[i];
  const double q = sums.q;
  const double qu = sums.qu - full.mean_u * q;
  const double qv = sums.qv - full.mean_v * q;
  const double alpha = full.inverse_uu * qu + full.inverse_uv * qv;
  const double beta = full.inverse_uv * qu + full.inverse_vv * qv;
  return {alpha, beta, q / full.n - alpha * full.mean_u - beta * full.mean_v};
}

float MomentPyramid::meanSquare(const QuadtreeNode& node, const Eigen::Vector3f& plane) const {
  const DepthSums& sums = level(node).depth[index(node)];
  // Residuals of a regression are orthogonal to it.
  const double explained = plane.cast<double>().dot(Eigen::Vector3d(sums.qu, sums.qv, sums.q));
  const double mean = (sums.qq - explained) / level(node).counts[index(node)];
  return static_cast<float>(std::max(0.0, mean));
}

ResidualSums MomentPyramid::residuals(const TileRect& rect, const Eigen::Vector3f& plane) const {
  const std::size_t first = offset(rect.x, rect.y);
  ResidualQuery query;
  query.inverse_depth = &inverse_depth_[first];
  query.tangents = {&tangents_u_[first], &tangents_v_[first], stride_};
  query.width = rect.width;
  query.rows = rect.height;
  query.alpha = plane.x();
  query.beta = plane.y();
  query.gamma = plane.z();
  return kernels_.residuals(query);
}

}  // namespace planecloud

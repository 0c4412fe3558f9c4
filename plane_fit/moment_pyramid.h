// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "planecloud_slam/plane_fit/camera.h"
#include "planecloud_slam/plane_fit/plane_regression.h"
#include "planecloud_slam/plane_fit/quadtree_grid.h"
#include "planecloud_slam/plane_fit/tangent_tables.h"
#include "planecloud_slam/plane_fit/tile_kernels.h"

namespace planecloud {

/// The moments of every node of the quadtrees over one depth image: cells are summed in one pass
/// over the pixels, then merged upwards: plain addition, as tangents are taken about the centre of
/// the node's initial tile.
class MomentPyramid {
 public:
  /// Throws std::invalid_argument for a layout out of range.
  MomentPyramid(const std::shared_ptr<const Camera>& camera, const QuadtreeLayout& layout,
                const TileKernels& kernels);

  /// Reads a depth image of the camera's size. Returns false, and leaves the pyramid unusable,
  /// when `give_up` (asked once per row of cells) says so.
  [[nodiscard]] bool read(ImageView<float> depth, const std::function<bool()>& give_up);
  [[nodiscard]] bool read(ImageView<std::uint16_t> depth, const std::function<bool()>& give_up);

  [[nodiscard]] const QuadtreeGrid& grid() const { return grid_; }
  [[nodiscard]] const TileKernels& kernels() const { return kernels_; }

  /// All nodes of a level, row-major.
  [[nodiscard]] NodeRows rows(int level) const {
    const Level& nodes = levels_[static_cast<std::size_t>(level)];
    return {tables_.level(level).full.n.data(), nodes.counts.data(), nodes.depth.data(),
            nodes.planes.data()};
  }
  /// Pixels with depth in the node.
  [[nodiscard]] int count(const QuadtreeNode& node) const {
    return static_cast<int>(level(node).counts[index(node)]);
  }
  /// All pixels of the node.
  [[nodiscard]] int area(const QuadtreeNode& node) const {
    return static_cast<int>(tables_.level(node.level).full.n[index(node)]);
  }
  /// Every pixel of the node has depth.
  [[nodiscard]] bool isFull(const QuadtreeNode& node) const {
    const std::size_t i = index(node);
    return level(node).counts[i] == tables_.level(node.level).full.n[i];
  }
  /// Each corner of the node has depth within `window` pixels along both sides; empty where the
  /// moments cannot tell.
  [[nodiscard]] std::optional<bool> hasDepthAtCorners(const QuadtreeNode& node, int window) const;
  /// Mean inverse depth [1/m] of a node with count > 0.
  [[nodiscard]] float meanInverseDepth(const QuadtreeNode& node) const {
    return level(node).depth[index(node)].q / level(node).counts[index(node)];
  }
  /// The whole scatter matrix of a node, about `origin(node)`.
  [[nodiscard]] TileMoments moments(const QuadtreeNode& node) const;
  /// Regression of a node with count > 0 about `origin(node)`.
  [[nodiscard]] NodePlane regress(const QuadtreeNode& node) const {
    return isFull(node) ? level(node).planes[index(node)] : regressWithHoles(node);
  }
  /// Tangents (u, v) of the centre of the node's initial tile.
  [[nodiscard]] const Eigen::Vector2f& origin(const QuadtreeNode& node) const {
    const int columns = tables_.level(0).columns;
    const int root = (node.row >> node.level) * columns + (node.column >> node.level);
    return tables_.origin(static_cast<std::size_t>(root));
  }

  /// Inverse depth [1/m] of a pixel, 0: none.
  [[nodiscard]] float inverseDepth(int x, int y) const {
    return inverse_depth_[tables_.offset(x, y)];
  }
  /// Tangents of a pixel about the centre of its initial tile.
  [[nodiscard]] Eigen::Vector2f tangents(int x, int y) const { return tables_.at(x, y); }
  /// Errors of a plane about the origin of the rectangle's initial tile.
  [[nodiscard]] ResidualSums residuals(const TileRect& rect, const Eigen::Vector3f& plane) const;
  /// Errors of a plane about the origin of a node with depth, guessed from every fourth row of
  /// pixels.
  [[nodiscard]] ResidualSums sampleResiduals(const QuadtreeNode& node,
                                             const Eigen::Vector3f& plane) const;

 private:
  struct Level {
    std::vector<float> counts;
    std::vector<DepthSums> depth;
    std::vector<TangentSums> tangents;  // only written for nodes with holes
    std::vector<NodePlane> planes;      // only meant for the others
  };

  [[nodiscard]] const Level& level(const QuadtreeNode& node) const {
    return levels_[static_cast<std::size_t>(node.level)];
  }
  [[nodiscard]] std::size_t index(const QuadtreeNode& node) const {
    return static_cast<std::size_t>(node.row * tables_.level(node.level).columns + node.column);
  }
  template <typename Pixel>
  bool readPixels(ImageView<Pixel> depth, const std::function<bool()>& give_up);
  template <typename Pixel>
  void sumStrip(ImageView<Pixel> depth, int row);
  void sumCells(int row);
  void sumHoles(int row);
  [[nodiscard]] NodePlane regressWithHoles(const QuadtreeNode& node) const;
  [[nodiscard]] PixelBlock pixels(const TileRect& rect) const;
  void merge(int parent_level);
  [[nodiscard]] TangentSums mergeTangents(int level, const std::array<std::size_t, 4>& nodes) const;

  const TileKernels& kernels_;
  QuadtreeGrid grid_;
  TangentTables tables_;
  bool uniform_cells_ = false;  // all cells are as wide as the first
  std::vector<Level> levels_;
  std::vector<float> inverse_depth_;  // rows as those of the tables
  std::vector<float> columns_n_, columns_q_, columns_qu_, columns_qv_, columns_qq_;
};

}  // namespace planecloud

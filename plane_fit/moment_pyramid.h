// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "planecloud_slam/plane_fit/camera.h"
#include "planecloud_slam/plane_fit/plane_regression.h"
#include "planecloud_slam/plane_fit/quadtree_grid.h"
#include "planecloud_slam/plane_fit/tile_kernels.h"

namespace planecloud {

/// The moments of every node of the quadtrees over one depth image: cells are summed in one pass
/// over the pixels, then merged upwards. What depends on the camera alone is computed once.
/// Tangents are taken about the centre of the node's initial tile, so that float sums keep their
/// digits and merging is plain addition.
class MomentPyramid {
 public:
  /// Throws std::invalid_argument for a layout out of range.
  MomentPyramid(std::shared_ptr<const Camera> camera, const QuadtreeLayout& layout,
                const TileKernels& kernels);

  /// Reads a depth image of the camera's size. Returns false, and leaves the pyramid unusable,
  /// when `give_up` (asked once per row of cells) says so.
  [[nodiscard]] bool read(ImageView<float> depth, const std::function<bool()>& give_up);
  [[nodiscard]] bool read(ImageView<std::uint16_t> depth, const std::function<bool()>& give_up);

  [[nodiscard]] const QuadtreeGrid& grid() const { return grid_; }
  [[nodiscard]] const TileKernels& kernels() const { return kernels_; }

  /// Pixels with depth in the node.
  [[nodiscard]] int count(const QuadtreeNode& node) const {
    return static_cast<int>(level(node).counts[index(node)]);
  }
  /// All pixels of the node.
  [[nodiscard]] int area(const QuadtreeNode& node) const {
    return static_cast<int>(level(node).full[index(node)].n);
  }
  /// Mean inverse depth [1/m] of a node with count > 0.
  [[nodiscard]] float meanInverseDepth(const QuadtreeNode& node) const {
    return level(node).depth[index(node)].q / level(node).counts[index(node)];
  }
  /// The whole scatter matrix of a node, about `origin(node)`.
  [[nodiscard]] TileMoments moments(const QuadtreeNode& node) const;
  /// Regression of a node with count > 0 about `origin(node)`: (alpha, beta, gamma) [1/m].
  [[nodiscard]] Eigen::Vector3d regress(const QuadtreeNode& node) const;
  /// Mean square [1/m^2] of the residuals of the node's regression `plane`, from the moments.
  [[nodiscard]] float meanSquare(const QuadtreeNode& node, const Eigen::Vector3f& plane) const;
  /// Tangents (u, v) of the centre of the node's initial tile.
  [[nodiscard]] const Eigen::Vector2f& origin(const QuadtreeNode& node) const {
    const int root = (node.row >> node.level) * levels_[0].columns + (node.column >> node.level);
    return origins_[static_cast<std::size_t>(root)];
  }

  /// Inverse depth [1/m] of a pixel, 0: none.
  [[nodiscard]] float inverseDepth(int x, int y) const { return inverse_depth_[offset(x, y)]; }
  /// Tangents of a pixel about the centre of its initial tile.
  [[nodiscard]] Eigen::Vector2f tangents(int x, int y) const {
    return {tangents_u_[offset(x, y)], tangents_v_[offset(x, y)]};
  }
  /// Errors of a plane about the origin of the rectangle's initial tile.
  [[nodiscard]] ResidualSums residuals(const TileRect& rect, const Eigen::Vector3f& plane) const;

 private:
  /// Masked sums of the tangents over the pixels with depth.
  struct TangentSums {
    float u = 0.0F, v = 0.0F, uu = 0.0F, uv = 0.0F, vv = 0.0F;

    TangentSums& operator+=(const TangentSums& other) {
      u += other.u;
      v += other.v;
      uu += other.uu;
      uv += other.uv;
      vv += other.vv;
      return *this;
    }
  };
  /// What a node without holes needs: known from the camera alone.
  struct FullNode {
    float n = 0.0F;
    float mean_u = 0.0F, mean_v = 0.0F;
    float inverse_uu = 0.0F, inverse_uv = 0.0F, inverse_vv = 0.0F;
  };
  struct Level {
    int columns = 0;
    std::vector<FullNode> full;
    std::vector<TangentSums> full_tangents;
    std::vector<float> counts;
    std::vector<DepthSums> depth;
    std::vector<TangentSums> tangents;  // only written for nodes with holes
  };

  [[nodiscard]] const Level& level(const QuadtreeNode& node) const {
    return levels_[static_cast<std::size_t>(node.level)];
  }
  [[nodiscard]] std::size_t index(const QuadtreeNode& node) const {
    return static_cast<std::size_t>(node.row * level(node).columns + node.column);
  }
  [[nodiscard]] std::size_t offset(int x, int y) const {
    return static_cast<std::size_t>(y * stride_ + x);
  }
  void tabulateTangents();
  void tabulateFullNodes();
  void tabulateCell(int column, int row);
  void mergeFullNodes(std::size_t parent_level);
  static void prepareRegression(const TangentSums& sums, FullNode& full);
  template <typename Pixel>
  bool readPixels(ImageView<Pixel> depth, const std::function<bool()>& give_up);
  template <typename Pixel>
  void sumStrip(ImageView<Pixel> depth, int row);
  void sumCells(int row);
  void sumHoles(int row);
  void merge(std::size_t parent_level);
  [[nodiscard]] static TangentSums mergeTangents(const Level& level,
                                                 const std::array<std::size_t, 4>& nodes);

  std::shared_ptr<const Camera> camera_;
  const TileKernels& kernels_;
  QuadtreeGrid grid_;
  std::ptrdiff_t stride_ = 0;
  bool uniform_cells_ = false;  // all cells are as wide as the first
  std::vector<Level> levels_;
  std::vector<Eigen::Vector2f> origins_;  // of the initial tiles
  std::vector<float> tangents_u_, tangents_v_, inverse_depth_;
  std::vector<float> columns_n_, columns_q_, columns_qu_, columns_qv_, columns_qq_;
};

}  // namespace planecloud

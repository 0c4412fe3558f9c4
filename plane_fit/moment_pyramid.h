// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "planecloud_slam/plane_fit/camera.h"
#include "planecloud_slam/plane_fit/depth_traits.h"
#include "planecloud_slam/plane_fit/moment_list.h"
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
                const TileKernels& kernels, const DistortionRule& rule = {});

  /// Reads a depth image of the camera's size, which must stay where it is as long as questions
  /// about pixels are asked. Returns false, and leaves the pyramid unusable,
  /// when `give_up` (asked once per row of cells) says so.
  [[nodiscard]] bool read(ImageView<float> depth, const std::function<bool()>& give_up);
  [[nodiscard]] bool read(ImageView<std::uint16_t> depth, const std::function<bool()>& give_up);

  [[nodiscard]] const QuadtreeGrid& grid() const { return grid_; }

  /// Of all nodes of a level, row-major.
  [[nodiscard]] const std::vector<Fill>& fills(int level) const {
    return levels_[static_cast<std::size_t>(level)].fills;
  }
  /// Pixels with depth.
  [[nodiscard]] const std::vector<float>& counts(int level) const {
    return levels_[static_cast<std::size_t>(level)].counts;
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
    return level(node).fills[index(node)] == Fill::kAll;
  }
  /// Each corner of the node has depth within `window` pixels along both sides; empty where the
  /// moments cannot tell.
  [[nodiscard]] std::optional<bool> hasDepthAtCorners(const QuadtreeNode& node, int window) const;
  /// Mean inverse depth [1/m] of a node with count > 0.
  [[nodiscard]] float meanInverseDepth(const QuadtreeNode& node) const {
    return level(node).depth[index(node)].q / level(node).counts[index(node)];
  }
  /// The whole scatter matrix of a node, about `origin(node)`.
  [[nodiscard]] TileMoments moments(const QuadtreeNode& node) const {
    return moments(node.level, index(node));
  }
  /// Regression of a node with count > 0 about `origin(node)`.
  [[nodiscard]] NodePlane regress(const QuadtreeNode& node) const {
    const bool is_cell = node.level + 1 == grid_.levels();
    return is_cell ? regressCell(node) : level(node).planes[index(node)];
  }
  /// How the residuals of a regression weigh in a node with count > 0, by the rule; negative where
  /// it is not known: the plane may be too far off (see `NodePlane`).
  [[nodiscard]] float distortion(const QuadtreeNode& node) const {
    return level(node).distortions[index(node)];
  }
  /// Tangents (u, v) of the centre of the node's initial tile.
  [[nodiscard]] const Eigen::Vector2f& origin(const QuadtreeNode& node) const {
    const int columns = tables_.level(0).columns;
    const int root = (node.row >> node.level) * columns + (node.column >> node.level);
    return tables_.origin(static_cast<std::size_t>(root));
  }

  /// Some pixel of a rectangle has depth.
  [[nodiscard]] bool hasDepth(const TileRect& rect) const;
  /// Inverse depth [1/m] of a pixel, 0: none.
  [[nodiscard]] float inverseDepth(int x, int y) const {
    return std::visit([&](const auto& depth) { return inverse(depth(x, y)); }, depth_);
  }
  /// Tangents of a pixel about the centre of its initial tile.
  [[nodiscard]] Eigen::Vector2f tangents(int x, int y) const { return tables_.at(x, y); }
  /// Errors of a plane about the origin of the rectangle's initial tile.
  [[nodiscard]] ResidualSums residuals(const TileRect& rect, const NodePlane& plane) const;
  /// Errors of a plane about the origin of a node with depth, guessed from some of its
  /// pixels.
  [[nodiscard]] ResidualSums sampleResiduals(const QuadtreeNode& node,
                                             const NodePlane& plane) const;

 private:
  struct Level {
    std::vector<float> counts;
    std::vector<DepthSums> depth;
    std::vector<TangentSums> tangents;  // only written for nodes with holes
    std::vector<NodePlane> planes;      // not of cells
    std::vector<float> distortions;
    std::vector<Fill> fills;
  };

  [[nodiscard]] const Level& level(const QuadtreeNode& node) const {
    return levels_[static_cast<std::size_t>(node.level)];
  }
  [[nodiscard]] std::size_t index(const QuadtreeNode& node) const {
    return static_cast<std::size_t>(node.row * tables_.level(node.level).columns + node.column);
  }
  template <typename Pixel>
  [[nodiscard]] static float inverse(Pixel depth) {
    return DepthTraits<Pixel>::inverse(depth);
  }
  template <typename Pixel>
  [[nodiscard]] static DepthBlock<Pixel> block(ImageView<Pixel> depth, const TileRect& rect) {
    return {depth.row(rect.y) + rect.x, depth.stride(), rect.width, rect.height};
  }
  template <typename Pixel>
  [[nodiscard]] const PixelKernels<Pixel>& kernelsFor(const DepthBlock<Pixel>& /*block*/) const {
    return kernels_.of<Pixel>();
  }
  template <typename Pixel>
  bool readPixels(ImageView<Pixel> depth, const std::function<bool()>& give_up);
  [[nodiscard]] ColumnSums columns();
  void sumCells(int row);
  /// Goes over the cells that have holes or are so large that a lens is not affine in them.
  template <typename Pixel>
  void sumPixels(ImageView<Pixel> depth, int row);
  /// Regresses the nodes listed in `holes_`.
  void regressHoles(int level);
  [[nodiscard]] NodePlane regressCell(const QuadtreeNode& node) const;
  [[nodiscard]] PositionSums sumPositions(const TileRect& rect) const;
  void merge(int parent_level);
  [[nodiscard]] TileMoments moments(int level, std::size_t i) const;
  [[nodiscard]] TangentSums mergeTangents(int level, const std::array<std::size_t, 4>& nodes) const;

  const TileKernels& kernels_;
  QuadtreeGrid grid_;
  TangentTables tables_;
  DistortionRule rule_;
  int fours_ = 0;             // cells four columns wide before the first that is not
  bool small_cells_ = false;  // a lens is affine in them
  std::vector<Level> levels_;
  std::variant<ImageView<float>, ImageView<std::uint16_t>> depth_;
  MomentList holes_;
  std::vector<float> columns_n_, columns_q_, columns_qy_, columns_qq_;
};

}  // namespace planecloud

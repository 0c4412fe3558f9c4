// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
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

/// The moments of the nodes of the quadtrees over one depth image. Blocks, the largest nodes that
/// are no more than 8 pixels wide and high (cells, where these are larger), are summed in one pass
/// over the pixels, then merged upwards: plain addition, as tangents are taken about the centre of
/// the node's initial tile. What is smaller than a block is only summed when its parent is split.
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

  /// To be called before anything is asked about the children of `node`, which has some.
  void split(const QuadtreeNode& node);
  /// How many children with depth a node has, split or not.
  [[nodiscard]] int countChildren(const QuadtreeNode& node) const;

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
  [[nodiscard]] int area(const QuadtreeNode& node) const { return grid_.rect(node).area(); }
  /// Every pixel of the node has depth.
  [[nodiscard]] bool isFull(const QuadtreeNode& node) const {
    return level(node).fills[index(node)] == Fill::kAll;
  }
  /// Each corner of the node has depth within `window` pixels along both sides.
  [[nodiscard]] bool hasDepthAtCorners(const QuadtreeNode& node, int window) const;
  /// Mean inverse depth [1/m] of a node with count > 0.
  [[nodiscard]] float meanInverseDepth(const QuadtreeNode& node) const {
    return level(node).depth[index(node)].q / level(node).counts[index(node)];
  }
  /// The whole scatter matrix of a node, about `origin(node)`.
  [[nodiscard]] TileMoments moments(const QuadtreeNode& node) const;
  /// Regression of a node with count > 0 about `origin(node)`.
  [[nodiscard]] NodePlane regress(const QuadtreeNode& node) const {
    return node.level < block_level_ ? level(node).planes[index(node)] : regressSmall(node);
  }
  /// How the residuals of a regression weigh in a node with count > 0, by the rule; negative where
  /// it is not known: the plane may be too far off (see `NodePlane`).
  [[nodiscard]] float distortion(const QuadtreeNode& node) const {
    return level(node).distortions[index(node)];
  }
  /// Tangents (u, v) of the centre of the node's initial tile.
  [[nodiscard]] const Eigen::Vector2f& origin(const QuadtreeNode& node) const {
    const int root = (node.row >> node.level) * grid_.columns(0) + (node.column >> node.level);
    return tables_.origin(static_cast<std::size_t>(root));
  }

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
    std::vector<TangentSums> tangents;  // down to blocks, only written for nodes with holes
    std::vector<NodePlane> planes;      // down to blocks, of these only those with holes
    std::vector<float> distortions;
    std::vector<Fill> fills;
    std::vector<std::uint8_t> quarters;  // of small blocks, only written for those with holes
  };

  [[nodiscard]] const Level& level(const QuadtreeNode& node) const {
    return levels_[static_cast<std::size_t>(node.level)];
  }
  [[nodiscard]] const Level& blocks() const {
    return levels_[static_cast<std::size_t>(block_level_)];
  }
  [[nodiscard]] std::size_t index(const QuadtreeNode& node) const {
    return static_cast<std::size_t>(node.row * grid_.columns(node.level) + node.column);
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
  void sumBlocks(int row);
  /// Goes over the blocks that have holes or are so large that a lens is not affine in them.
  template <typename Pixel>
  void sumPixels(ImageView<Pixel> depth, int row);
  void merge(int parent_level);
  /// Regresses the nodes of a level that are listed in `listed_`.
  void regressListed(int level);
  template <typename Pixel>
  void splitPixels(ImageView<Pixel> depth, const QuadtreeNode& node);

  /// Some pixel of a rectangle has depth.
  [[nodiscard]] bool hasDepth(const TileRect& rect) const;
  /// Not cut off by the image's border, nor one of the smaller ones of an odd layout.
  [[nodiscard]] bool isWholeBlock(std::size_t block) const {
    return tables_.level(block_level_).full.n[block] == static_cast<float>(first_block_.area());
  }
  /// Some pixel of a quarter of a whole block has depth (see PositionSums).
  [[nodiscard]] bool quarterHasDepth(std::size_t block, int quarter) const {
    const Fill fill = blocks().fills[block];
    return fill == Fill::kPart ? (blocks().quarters[block] >> quarter & 1) != 0
                               : fill == Fill::kAll;
  }
  /// Of a block or smaller.
  [[nodiscard]] NodePlane regressSmall(const QuadtreeNode& node) const;
  /// Of a node in which tangents are affine.
  [[nodiscard]] PositionSums sumPositions(const QuadtreeNode& node) const;
  [[nodiscard]] LocalTangents localTangents(const QuadtreeNode& node) const;
  /// Of a node with depth, over the pixels that have it.
  [[nodiscard]] TangentSums sumTangents(const QuadtreeNode& node) const;
  [[nodiscard]] TileMoments moments(int level, std::size_t i, const TangentSums& tangents) const;
  [[nodiscard]] TangentSums mergeTangents(int level, const std::array<std::size_t, 4>& nodes) const;

  const TileKernels& kernels_;
  QuadtreeGrid grid_;
  int block_level_;
  TangentTables tables_;
  DistortionRule rule_;
  bool small_blocks_ = false;     // a lens is affine in them
  TileRect first_block_;          // none is larger
  std::vector<int> block_edges_;  // first columns of the blocks of a row, at last the end
  int alike_ = 0;                 // so many blocks, from the first on, are as wide as the first
  std::vector<Level> levels_;
  std::variant<ImageView<float>, ImageView<std::uint16_t>> depth_;
  MomentList listed_;  // nodes that regression cannot take for full
  std::vector<float> columns_n_, columns_q_, columns_qy_, columns_qq_;
};

}  // namespace planecloud

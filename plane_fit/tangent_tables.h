// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "planecloud_slam/plane_fit/camera.h"
#include "planecloud_slam/plane_fit/quadtree_grid.h"
#include "planecloud_slam/plane_fit/tile_kernels.h"

namespace planecloud {

/// What regression needs of the nodes of one level when they have no holes (see `FullNodeRows`).
struct FullNodes {
  std::vector<float> n, inverse_n;  ///< pixels
  std::vector<float> mean_u, mean_v, reach_u, reach_v;
  std::vector<float> inverse_uu, inverse_uv, inverse_vv;

  void resize(std::size_t nodes);
  /// The nodes from `first` on.
  [[nodiscard]] FullNodeRows from(std::size_t first) const {
    return {&inverse_n[first], &mean_u[first],     &mean_v[first],     &reach_u[first],
            &reach_v[first],   &inverse_uu[first], &inverse_uv[first], &inverse_vv[first]};
  }
};

/// What the moments of an image owe to the camera alone, computed once: the tangents of every
/// pixel, taken about the centre of its initial tile so that float sums keep their digits, and the
/// sums over all pixels of every node.
class TangentTables {
 public:
  struct Level {
    int columns = 0;
    FullNodes full;
    std::vector<TangentSums> sums;
  };

  TangentTables(const Camera& camera, const QuadtreeGrid& grid);

  /// Floats from one row of pixels to the next; rows may be read `kRowPadding` past their end.
  [[nodiscard]] std::ptrdiff_t stride() const { return stride_; }
  /// Floats of an image with rows like these.
  [[nodiscard]] std::size_t size() const { return u_.size(); }
  [[nodiscard]] std::size_t offset(int x, int y) const {
    return static_cast<std::size_t>(y * stride_ + x);
  }
  [[nodiscard]] Eigen::Vector2f at(int x, int y) const {
    return {u_[offset(x, y)], v_[offset(x, y)]};
  }
  /// The rows from pixel (x, y) on.
  [[nodiscard]] TangentRows from(int x, int y) const {
    return {&u_[offset(x, y)], &v_[offset(x, y)], stride_};
  }
  /// Tangents of the centre of an initial tile, row-major.
  [[nodiscard]] const Eigen::Vector2f& origin(std::size_t root) const { return origins_[root]; }
  [[nodiscard]] const Level& level(int i) const { return levels_[static_cast<std::size_t>(i)]; }

 private:
  void tabulatePixels(const Camera& camera, const QuadtreeGrid& grid);
  void tabulateCells(const QuadtreeGrid& grid);
  void mergeLevel(std::size_t parent_level);
  void prepareRegressions(const QuadtreeGrid& grid);
  void measureReach(const TileRect& rect, std::size_t node, FullNodes& full) const;

  std::ptrdiff_t stride_ = 0;
  std::vector<float> u_, v_;
  std::vector<Eigen::Vector2f> origins_;
  std::vector<Level> levels_;
};

}  // namespace planecloud

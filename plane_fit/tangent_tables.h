// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "planecloud_slam/plane_fit/camera.h"
#include "planecloud_slam/plane_fit/plane_regression.h"
#include "planecloud_slam/plane_fit/quadtree_grid.h"
#include "planecloud_slam/plane_fit/tile_kernels.h"

namespace planecloud {

/// Moments of `n` pixels without their depth.
[[nodiscard]] TileMoments tangentMoments(double n, const TangentSums& sums);

/// What regression needs of the nodes of one level when they have no holes (see `FullNodeRows`).
struct FullNodes {
  std::vector<float> n, inverse_n;  ///< pixels
  std::vector<float> mean_u, mean_v, reach_u, reach_v;
  std::vector<float> inverse_uu, inverse_uv, inverse_vv;

  void resize(std::size_t nodes);
  /// The nodes from `first` on.
  [[nodiscard]] FullNodeRows from(std::size_t first) const {
    return {&n[first],          &inverse_n[first],  &mean_u[first],
            &mean_v[first],     &reach_u[first],    &reach_v[first],
            &inverse_uu[first], &inverse_uv[first], &inverse_vv[first]};
  }
};

/// Of every node of the finest level, row-major (see `CellTangents`): the affine function nearest
/// to its pixels' tangents.
struct AffineTangents {
  std::vector<float> u, u_right, u_down, v, v_right, v_down;

  void resize(std::size_t nodes);
  [[nodiscard]] LocalTangents at(std::size_t i) const {
    return {u[i], u_right[i], u_down[i], v[i], v_right[i], v_down[i]};
  }
  /// The nodes from `first` on.
  [[nodiscard]] CellTangents from(std::size_t first) const {
    return {&u[first], &u_right[first], &u_down[first], &v[first], &v_right[first], &v_down[first]};
  }
};

/// What the moments of an image owe to the camera alone, computed once: the tangents of every
/// pixel, taken about the centre of its initial tile so that float sums keep their digits, and the
/// sums over all pixels of every node of the coarser levels.
class TangentTables {
 public:
  struct Level {
    FullNodes full;
    std::vector<TangentSums> sums;
  };

  /// For the levels down to `finest`.
  TangentTables(const Camera& camera, const QuadtreeGrid& grid, int finest);

  [[nodiscard]] Eigen::Vector2f at(int x, int y) const { return {u_(x, y), v_(x, y)}; }
  /// The rows from pixel (x, y) on.
  [[nodiscard]] TangentRows from(int x, int y) const { return {&u_(x, y), &v_(x, y), u_.width()}; }
  [[nodiscard]] const AffineTangents& finest() const { return finest_; }
  /// Tangents of the centre of an initial tile, row-major.
  [[nodiscard]] const Eigen::Vector2f& origin(std::size_t root) const { return origins_[root]; }
  [[nodiscard]] const Level& level(int i) const { return levels_[static_cast<std::size_t>(i)]; }

 private:
  void tabulatePixels(const Camera& camera, const QuadtreeGrid& grid);
  void tabulateFinest(const QuadtreeGrid& grid);
  void approximate(const TileRect& rect, std::size_t node);
  void mergeLevel(std::size_t parent_level, const QuadtreeGrid& grid);
  void prepareRegressions(const QuadtreeGrid& grid);
  void measureReach(const TileRect& rect, std::size_t node, FullNodes& full) const;

  Image<float> u_, v_;
  AffineTangents finest_;
  std::vector<Eigen::Vector2f> origins_;
  std::vector<Level> levels_;
};

}  // namespace planecloud

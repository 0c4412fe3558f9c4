// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

#include "planecloud_slam/plane_fit/quadtree_grid.h"

namespace planecloud {

/// A plane over a tile in integers: inverse depth at the tile's centre and its change from there
/// to the right and to the lower edge, in units of `TileQuantiser::unit()`.
struct QuantisedPlane {
  static constexpr std::int32_t kMax = 1 << 24;  ///< no number is larger than this

  std::int32_t center = 0;
  std::int32_t right = 0;
  std::int32_t down = 0;
  friend bool operator==(const QuantisedPlane& a, const QuantisedPlane& b) {
    return a.center == b.center && a.right == b.right && a.down == b.down;
  }
};

/// Maps planes to integers and back, the same on every machine. Larger tiles are quantised finer,
/// since their error weighs on more pixels: one step of a cell's centre is `quantisation_step`,
/// one level up it is half of it, down to 1/16. Slopes take steps twice as long.
class TileQuantiser {
 public:
  static constexpr int kUnitBits = 4;               ///< units per step of a cell: 2^4
  static constexpr int kMinStep = 10;               ///< of `quantisation_step` [kStepUnit]
  static constexpr int kMaxStep = 5000;             ///< of `quantisation_step` [kStepUnit]
  static constexpr double kStepUnit = 1e-5;         ///< of `quantisation_step` on the wire [1/m]
  static constexpr double kMaxInverseDepth = 64.0;  ///< [1/m]

  /// `step` in `kStepUnit`, [kMinStep, kMaxStep]; `camera` is rounded to float32 as it travels.
  TileQuantiser(const CameraIntrinsics& camera, const QuadtreeGrid& grid, int step);

  /// Empty when the plane does not lie in front of the camera all over the tile.
  [[nodiscard]] std::optional<QuantisedPlane> quantise(const PlanarTile& tile, int level) const;
  /// Empty when no tile quantises to these integers.
  [[nodiscard]] std::optional<PlanarTile> dequantise(const QuantisedPlane& plane,
                                                     const TileRect& rect, int level) const;

  /// log2 of the step of a centre in units on `level`; slopes one more.
  [[nodiscard]] int stepBits(int level) const;

 private:
  /// Where the integers refer to: tangents of the tile's centre and from there to its edges.
  struct Frame {
    double u, v, half_width, half_height;
  };
  [[nodiscard]] std::optional<Frame> frame(const TileRect& rect) const;
  [[nodiscard]] PlanarTile toTile(const QuantisedPlane& plane, const TileRect& rect,
                                  const Frame& frame) const;
  /// Centre, right and down of a plane in units, not yet rounded.
  [[nodiscard]] Eigen::Vector3d inUnits(const PlanarTile& tile, const Frame& frame) const;
  [[nodiscard]] QuantisedPlane round(const Eigen::Vector3d& units, int level) const;
  /// In front of the camera, and the integers survive the way through float coefficients.
  [[nodiscard]] bool isStable(const QuantisedPlane& plane, const TileRect& rect, const Frame& frame,
                              int level) const;

  CameraIntrinsics camera_;
  int finest_level_;
  double unit_;  // [1/m]
};

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace planecloud {

/// The paper's scatter matrix of a tile (eq. (4)) as sums over its pixels with depth: tangents
/// u, v [-] about any fixed origin, inverse depth q [1/m].
struct TileMoments {
  double n = 0.0, u = 0.0, v = 0.0, uu = 0.0, uv = 0.0, vv = 0.0;
  double q = 0.0, qu = 0.0, qv = 0.0, qq = 0.0;

  void add(double pixel_u, double pixel_v, double pixel_q, double weight = 1.0);
  TileMoments& operator+=(const TileMoments& other);
};

/// Least squares of q = alpha u + beta v + gamma, about the moments' origin (n > 0). Where the
/// pixels do not span a direction (one row, one column, a diagonal) the slope across it is 0.
[[nodiscard]] Eigen::Vector3d regressInverseDepth(const TileMoments& moments);
/// Root mean square of what the regression `plane` leaves (n > 0).
[[nodiscard]] double rootMeanSquare(const TileMoments& moments, const Eigen::Vector3d& plane);

/// Mean square spread of pixels below which a direction counts as not spanned, relative to the
/// other one: tiles are at most 80 px long (variance 533 px^2), two neighbouring rows have 1/4
/// px^2.
inline constexpr double kMinSpreadRatio = 1e-5;
/// What is left of the spread of a single pixel, which has no direction: rounding.
inline constexpr double kRoundingSpreadRatio = 1e-12;

/// The inverse of the centred 2x2 scatter of (u, v), pseudo-inverse where it is singular.
struct TangentScatterInverse {
  double uu = 0.0, uv = 0.0, vv = 0.0;
};
[[nodiscard]] TangentScatterInverse invertTangentScatter(const TileMoments& moments);

}  // namespace planecloud

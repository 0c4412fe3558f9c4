// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include "planecloud_slam/plane_fit/depth_traits.h"
#include "planecloud_slam/plane_fit/tile_kernels.h"

/// The scalar loops, which the vector kernels also use for what a vector does not fill.
namespace planecloud::scalar {

/// Columns [first, strip.width).
template <typename Pixel>
void sumColumns(const DepthStrip<Pixel>& strip, const ColumnSums& sums, int first) {
  for (int x = first; x < strip.width; ++x) {
    float n = 0.0F, q = 0.0F, qu = 0.0F, qv = 0.0F, qq = 0.0F;
    for (int y = 0; y < strip.rows; ++y) {
      const float value = DepthTraits<Pixel>::inverse(strip.depth[y * strip.depth_stride + x]);
      const std::ptrdiff_t at = y * strip.tangents.stride + x;
      strip.inverse_depth[at] = value;
      n += value > 0.0F ? 1.0F : 0.0F;
      q += value;
      qu += value * strip.tangents.u[at];
      qv += value * strip.tangents.v[at];
      qq += value * value;
    }
    sums.n[x] = n;
    sums.q[x] = q;
    sums.qu[x] = qu;
    sums.qv[x] = qv;
    sums.qq[x] = qq;
  }
}

/// Cells [first, cells).
inline void sumCells(const ColumnSums& columns, int cell_width, int first, int cells,
                     DepthSums* sums, float* counts) {
  for (int cell = first; cell < cells; ++cell) {
    DepthSums sum;
    float n = 0.0F;
    for (int x = cell * cell_width; x < (cell + 1) * cell_width; ++x) {
      n += columns.n[x];
      sum.q += columns.q[x];
      sum.qu += columns.qu[x];
      sum.qv += columns.qv[x];
      sum.qq += columns.qq[x];
    }
    sums[cell] = sum;
    counts[cell] = n;
  }
}

inline ResidualSums residuals(const ResidualQuery& query) {
  ResidualSums sums;
  for (int y = 0; y < query.rows; ++y) {
    for (int x = 0; x < query.width; ++x) {
      const std::ptrdiff_t at = y * query.tangents.stride + x;
      const float q = query.inverse_depth[at];
      if (!(q > 0.0F)) continue;
      const float plane =
          query.alpha * query.tangents.u[at] + query.beta * query.tangents.v[at] + query.gamma;
      const float error = std::abs(q - plane);
      const float depth_error = error / std::abs(q * plane);
      sums.inverse_depth += error;
      sums.relative += depth_error * std::abs(plane);
      sums.depth += depth_error;
    }
  }
  return sums;
}

}  // namespace planecloud::scalar

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
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

inline TangentSums sumTangents(const PixelBlock& pixels) {
  TangentSums sums;
  for (int y = 0; y < pixels.rows; ++y) {
    for (int x = 0; x < pixels.width; ++x) {
      const std::ptrdiff_t at = y * pixels.tangents.stride + x;
      if (!(pixels.inverse_depth[at] > 0.0F)) continue;
      const float u = pixels.tangents.u[at];
      const float v = pixels.tangents.v[at];
      sums += {u, v, u * u, u * v, v * v};
    }
  }
  return sums;
}

/// Nodes [first, count).
inline void regress(const DepthSums* sums, const FullNodeRows& nodes, std::size_t first,
                    std::size_t count, NodePlane* planes) {
  for (std::size_t i = first; i < count; ++i) {
    const double q = sums[i].q;
    const double inverse_n = nodes.inverse_n[i];
    const double mean = q * inverse_n;
    const double qu = sums[i].qu - nodes.mean_u[i] * q;
    const double qv = sums[i].qv - nodes.mean_v[i] * q;
    const double alpha = nodes.inverse_uu[i] * qu + nodes.inverse_uv[i] * qv;
    const double beta = nodes.inverse_uv[i] * qu + nodes.inverse_vv[i] * qv;
    // Residuals of a regression are orthogonal to it.
    const double squares = sums[i].qq - mean * q - alpha * qu - beta * qv;
    const double lowest =
        mean - std::abs(alpha) * nodes.reach_u[i] - std::abs(beta) * nodes.reach_v[i];
    const float rms = std::sqrt(static_cast<float>(std::max(0.0, squares * inverse_n)));
    planes[i].alpha = static_cast<float>(alpha);
    planes[i].beta = static_cast<float>(beta);
    planes[i].gamma = static_cast<float>(mean - alpha * nodes.mean_u[i] - beta * nodes.mean_v[i]);
    planes[i].rms = lowest >= double{kMinPlaneInverseDepth} ? rms : -rms;
  }
}

/// Nodes [first, count).
inline void weigh(const NodeRows& nodes, const DistortionRule& rule, std::size_t first,
                  std::size_t count, float* distortions) {
  for (std::size_t i = first; i < count; ++i) {
    const float n = nodes.counts[i];
    const float rms = nodes.planes[i].rms;
    const bool known = n > 0.0F && n == nodes.full[i] && !std::signbit(rms);
    const float depth = known ? n / nodes.sums[i].q : 0.0F;
    float scale = rule.factor * n;
    for (int power = 0; power < rule.depth_power; ++power) scale *= depth;
    distortions[i] = known ? scale * rms : -1.0F;
  }
}

inline ResidualSums residuals(const ResidualQuery& query) {
  ResidualSums sums;
  const PixelBlock& pixels = query.pixels;
  for (int y = 0; y < pixels.rows; ++y) {
    for (int x = 0; x < pixels.width; ++x) {
      const std::ptrdiff_t at = y * pixels.tangents.stride + x;
      const float q = pixels.inverse_depth[at];
      if (!(q > 0.0F)) continue;
      const float plane =
          query.alpha * pixels.tangents.u[at] + query.beta * pixels.tangents.v[at] + query.gamma;
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

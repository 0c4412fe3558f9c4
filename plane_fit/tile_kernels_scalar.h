// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

#include "planecloud_slam/plane_fit/depth_traits.h"
#include "planecloud_slam/plane_fit/plane_regression.h"
#include "planecloud_slam/plane_fit/tile_kernels.h"

/// The scalar loops, which the vector kernels also use for what a vector does not fill.
namespace planecloud::scalar {

/// Columns [first, strip.width).
template <typename Pixel>
void sumColumns(const DepthBlock<Pixel>& strip, const ColumnSums& sums, int first) {
  for (int x = first; x < strip.width; ++x) {
    float n = 0.0F, q = 0.0F, qy = 0.0F, qq = 0.0F;
    for (int y = 0; y < strip.rows; ++y) {
      const float value = DepthTraits<Pixel>::inverse(strip.depth[y * strip.stride + x]);
      n += value > 0.0F ? 1.0F : 0.0F;
      q += value;
      qy += value * static_cast<float>(y);
      qq += value * value;
    }
    sums.n[x] = n;
    sums.q[x] = q;
    sums.qy[x] = qy;
    sums.qq[x] = qq;
  }
}

/// Of a mean square that rounding may have made negative.
inline float root(double squares) { return std::sqrt(static_cast<float>(std::max(0.0, squares))); }

/// The spread of pixels 0 .. side - 1: the sum of squares about their mean.
inline double spread(int side) { return side * (side * side - 1) / 12.0; }

/// Of a cell's regression on pixel positions: `qx` and `qy` are sums of inverse depth times the
/// pixel's column and row in the cell.
inline float weighCell(const DistortionRule& rule, int width, int height, const DepthSums& sums,
                       double qx, double qy) {
  const double n = width * height;
  const double mean = sums.q / n;
  qx -= 0.5 * (width - 1) * sums.q;
  qy -= 0.5 * (height - 1) * sums.q;
  const double right = width > 1 ? qx / (height * spread(width)) : 0.0;
  const double down = height > 1 ? qy / (width * spread(height)) : 0.0;
  const double squares = sums.qq - mean * sums.q - right * qx - down * qy;
  const double reach = 0.5 * ((width - 1) * std::abs(right) + (height - 1) * std::abs(down));
  if (mean - reach < double{kMinPlaneInverseDepth}) return -1.0F;
  return rule.weigh(static_cast<float>(n), sums.q, root(squares / n));
}

/// Cells [first, row.cells).
inline void sumCells(const ColumnSums& columns, const CellRow& row, const DistortionRule& rule,
                     int first, const CellSums& sums) {
  for (int cell = first; cell < row.cells; ++cell) {
    DepthSums sum;
    float n = 0.0F, qx = 0.0F, qy = 0.0F;
    const int begin = row.edges[cell];
    const int end = row.edges[cell + 1];
    for (int x = begin; x < end; ++x) {
      n += columns.n[x];
      sum.q += columns.q[x];
      qx += columns.q[x] * static_cast<float>(x - begin);
      qy += columns.qy[x];
      sum.qq += columns.qq[x];
    }
    const CellTangents& t = row.tangents;
    sum.qu = t.u[cell] * sum.q + t.u_right[cell] * qx + t.u_down[cell] * qy;
    sum.qv = t.v[cell] * sum.q + t.v_right[cell] * qx + t.v_down[cell] * qy;
    sums.depth[cell] = sum;
    sums.counts[cell] = n;
    sums.fills[cell] = fillOf(n, static_cast<float>((end - begin) * row.height));
    sums.distortions[cell] =
        n > 0.0F ? weighCell(rule, end - begin, row.height, sum, qx, qy) : -1.0F;
  }
}

template <typename Pixel>
PositionSums sumPositions(const DepthBlock<Pixel>& block) {
  PositionSums sums;
  for (int row = 0; row < block.rows; ++row) {
    for (int column = 0; column < block.width; ++column) {
      if (DepthTraits<Pixel>::metres(block.depth[row * block.stride + column]) == 0.0F) continue;
      const auto x = static_cast<float>(column);
      const auto y = static_cast<float>(row);
      sums.n += 1.0F;
      sums.x += x;
      sums.y += y;
      sums.xx += x * x;
      sums.xy += x * y;
      sums.yy += y * y;
      const int quarter =
          2 * (2 * row > block.rows - 1 ? 1 : 0) + (2 * column > block.width - 1 ? 1 : 0);
      sums.quarters = static_cast<std::uint8_t>(sums.quarters | 1 << quarter);
    }
  }
  return sums;
}

/// Columns [first, block.width).
template <typename Pixel>
BlockSums sumBlock(const DepthBlock<Pixel>& block, const TangentRows& tangents, int first) {
  BlockSums sums;
  for (int y = 0; y < block.rows; ++y) {
    for (int x = first; x < block.width; ++x) {
      const float q = DepthTraits<Pixel>::inverse(block.depth[y * block.stride + x]);
      if (q == 0.0F) continue;
      const float u = tangents.u[y * tangents.stride + x];
      const float v = tangents.v[y * tangents.stride + x];
      sums += {{u, v, u * u, u * v, v * v}, q * u, q * v};
    }
  }
  return sums;
}

/// Nodes [first, count).
inline void regress(const DepthSums* sums, const FullNodeRows& nodes, const DistortionRule& rule,
                    std::size_t first, std::size_t count, const PlaneFits& fits) {
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
    const float rms = root(squares * inverse_n);
    const bool in_front = lowest >= double{kMinPlaneInverseDepth};
    NodePlane& plane = fits.planes[i];
    plane.alpha = static_cast<float>(alpha);
    plane.beta = static_cast<float>(beta);
    plane.gamma = static_cast<float>(mean - alpha * nodes.mean_u[i] - beta * nodes.mean_v[i]);
    plane.rms = in_front ? rms : -rms;
    fits.distortions[i] = in_front ? rule.weigh(nodes.n[i], sums[i].q, rms) : -1.0F;
  }
}

/// Nodes [first, count).
inline void regressMoments(const MomentRows& m, const PlaneRows& planes, std::size_t first,
                           std::size_t count) {
  for (std::size_t i = first; i < count; ++i) {
    const TileMoments moments{m.n[i],  m.u[i], m.v[i],  m.uu[i], m.uv[i],
                              m.vv[i], m.q[i], m.qu[i], m.qv[i], m.qq[i]};
    const Eigen::Vector3d plane = regressInverseDepth(moments);
    planes.alpha[i] = plane.x();
    planes.beta[i] = plane.y();
    planes.gamma[i] = plane.z();
    planes.rms[i] = rootMeanSquare(moments, plane);
  }
}

/// Columns [first, block.width).
template <typename Pixel>
ResidualSums residuals(const DepthBlock<Pixel>& block, const TangentRows& tangents,
                       const NodePlane& plane, int first) {
  ResidualSums sums;
  for (int y = 0; y < block.rows; ++y) {
    for (int x = first; x < block.width; ++x) {
      const float z = DepthTraits<Pixel>::metres(block.depth[y * block.stride + x]);
      if (z == 0.0F) continue;
      const std::ptrdiff_t at = y * tangents.stride + x;
      const float q = plane.alpha * tangents.u[at] + plane.beta * tangents.v[at] + plane.gamma;
      const float error = std::abs(1.0F - q * z);
      sums += {error / z, error, error / std::abs(q)};
    }
  }
  return sums;
}

}  // namespace planecloud::scalar

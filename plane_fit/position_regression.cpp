// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/plane_fit/position_regression.h"

#include <algorithm>
#include <cmath>

#include "planecloud_slam/plane_fit/plane_regression.h"

namespace planecloud {

TangentSums sumTangents(const PositionSums& sums, const LocalTangents& tangents) {
  const auto [u, u_x, u_y, v, v_x, v_y] = tangents;
  // Sums of u times 1, x and y; then the same for v.
  const float u_sum = u * sums.n + u_x * sums.x + u_y * sums.y;
  const float ux_sum = u * sums.x + u_x * sums.xx + u_y * sums.xy;
  const float uy_sum = u * sums.y + u_x * sums.xy + u_y * sums.yy;
  const float v_sum = v * sums.n + v_x * sums.x + v_y * sums.y;
  const float vx_sum = v * sums.x + v_x * sums.xx + v_y * sums.xy;
  const float vy_sum = v * sums.y + v_x * sums.xy + v_y * sums.yy;
  return {u_sum, v_sum, u * u_sum + u_x * ux_sum + u_y * uy_sum,
          v * u_sum + v_x * ux_sum + v_y * uy_sum, v * v_sum + v_x * vx_sum + v_y * vy_sum};
}

PositionSums allPositions(const TileRect& rect) {
  const auto w = static_cast<float>(rect.width);
  const auto h = static_cast<float>(rect.height);
  const float x = 0.5F * (w - 1.0F);  // means
  const float y = 0.5F * (h - 1.0F);
  const float n = w * h;
  return {n,         n * x,
          n * y,     n * x * (2.0F * w - 1.0F) / 3.0F,
          n * x * y, n * y * (2.0F * h - 1.0F) / 3.0F,
          15};
}

NodePlane regressPositions(const PositionSums& p, const DepthSums& sums,
                           const LocalTangents& tangents, const TileRect& rect) {
  const auto [u, u_x, u_y, v, v_x, v_y] = tangents;
  const float inverse_det = 1.0F / (u_x * v_y - u_y * v_x);
  const double exact_inverse_n = 1.0 / double{p.n};
  const auto inverse_n = static_cast<float>(exact_inverse_n);
  const float mean_x = p.x * inverse_n;
  const float mean_y = p.y * inverse_n;
  const float mean = sums.q * inverse_n;
  // Inverse depth times position, about the means.
  const float qu = sums.qu - u * sums.q;
  const float qv = sums.qv - v * sums.q;
  const float qx = (v_y * qu - u_y * qv) * inverse_det - mean_x * sums.q;
  const float qy = (u_x * qv - v_x * qu) * inverse_det - mean_y * sums.q;
  const float xx = p.xx - mean_x * p.x;
  const float xy = p.xy - mean_x * p.y;
  const float yy = p.yy - mean_y * p.y;
  const float trace = xx + yy;
  const float det = xx * yy - xy * xy;
  float right = 0.0F;
  float down = 0.0F;
  if (det > static_cast<float>(kMinSpreadRatio) * trace * trace) {
    const float scale = 1.0F / det;
    right = (yy * qx - xy * qy) * scale;
    down = (xx * qy - xy * qx) * scale;
  } else if (trace > 0.1F) {  // one line of pixels: no slope across it, see plane_regression.cpp
    right = (xx * qx + xy * qy) / (trace * trace);
    down = (xy * qx + yy * qy) / (trace * trace);
  }
  NodePlane plane;
  plane.alpha = (v_y * right - v_x * down) * inverse_det;
  plane.beta = (u_x * down - u_y * right) * inverse_det;
  const float first = mean - right * mean_x - down * mean_y;
  plane.gamma = first - plane.alpha * u - plane.beta * v;
  const double squares = double{sums.qq} - double{sums.q} * sums.q * exact_inverse_n;
  const auto rest = static_cast<float>(squares) - right * qx - down * qy;
  plane.rms = std::sqrt(std::max(0.0F, rest * inverse_n));
  const float lowest = first + std::min(0.0F, right * static_cast<float>(rect.width - 1)) +
                       std::min(0.0F, down * static_cast<float>(rect.height - 1));
  if (lowest < kMinPlaneInverseDepth) plane.rms = -plane.rms;
  return plane;
}

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>

#include "planecloud_slam/frontend_node/alignment_kernel.h"

namespace planecloud::scalar {

/// One point's whitened residuals and Jacobian rows.
struct WhitenedPoint {
  std::array<float, 6> row1;  ///< of e1 (grey), over the twist
  std::array<float, 6> row2;  ///< of e2 (inverse depth), over the twist
  float offset;               ///< of e1, over the offset unknown
  float gain;                 ///< of e1, over the gain unknown
  float e1;
  float e2;
  float weight;  ///< of the t-distribution, 0 for points not seen
};

/// A motion dp of the point changes the residuals by q g . dp: for inverse depth g is its plane
/// (alpha, beta, gamma), for grey its gradient, which does not change along the ray. Whitened, grey
/// minus slope times inverse depth; dp = rho + phi x p and p = (u, v, 1) / q.
inline WhitenedPoint whiten(const ReferencePoints& points, const ResidualView& residuals,
                            const Whitening& whitening, std::size_t i) {
  const float u = points.u[i];
  const float v = points.v[i];
  const float q = points.q[i];
  WhitenedPoint w;
  w.e1 = (residuals.grey[i] - whitening.slope * residuals.q[i]) * whitening.inverse_grey;
  w.e2 = residuals.q[i] * whitening.inverse_q;
  w.weight = residuals.seen[i] * (whitening.nu + 2.0F) / (whitening.nu + w.e1 * w.e1 + w.e2 * w.e2);
  w.offset = whitening.inverse_grey;
  w.gain = (points.grey[i] - kMiddleGrey) * (kInverseGreySpread * whitening.inverse_grey);
  const float b1 = points.q_u[i] * whitening.inverse_q;
  const float b2 = points.q_v[i] * whitening.inverse_q;
  const float b3 = q * whitening.inverse_q - b1 * u - b2 * v;
  const float to_q = whitening.slope * whitening.inverse_grey / whitening.inverse_q;
  const float i1 = points.grey_u[i] * whitening.inverse_grey;
  const float i2 = points.grey_v[i] * whitening.inverse_grey;
  const float a1 = i1 - to_q * b1;
  const float a2 = i2 - to_q * b2;
  const float a3 = -(i1 * u + i2 * v) - to_q * b3;
  w.row1 = {q * a1, q * a2, q * a3, v * a3 - a2, a1 - u * a3, u * a2 - v * a1};
  w.row2 = {q * b1, q * b2, q * b3, v * b3 - b2, b1 - u * b3, u * b2 - v * b1};
  return w;
}

}  // namespace planecloud::scalar

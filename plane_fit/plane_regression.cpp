// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/plane_fit/plane_regression.h"

#include <algorithm>
#include <cmath>

namespace planecloud {

void TileMoments::add(double pixel_u, double pixel_v, double pixel_q, double weight) {
  n += weight;
  u += weight * pixel_u;
  v += weight * pixel_v;
  uu += weight * pixel_u * pixel_u;
  uv += weight * pixel_u * pixel_v;
  vv += weight * pixel_v * pixel_v;
  q += weight * pixel_q;
  qu += weight * pixel_q * pixel_u;
  qv += weight * pixel_q * pixel_v;
  qq += weight * pixel_q * pixel_q;
}

TileMoments& TileMoments::operator+=(const TileMoments& other) {
  n += other.n;
  u += other.u;
  v += other.v;
  uu += other.uu;
  uv += other.uv;
  vv += other.vv;
  q += other.q;
  qu += other.qu;
  qv += other.qv;
  qq += other.qq;
  return *this;
}

TangentScatterInverse invertTangentScatter(const TileMoments& m) {
  const double inverse_n = 1.0 / m.n;
  const double uu = m.uu - m.u * m.u * inverse_n;
  const double uv = m.uv - m.u * m.v * inverse_n;
  const double vv = m.vv - m.v * m.v * inverse_n;
  const double trace = uu + vv;
  const double det = uu * vv - uv * uv;
  if (det > kMinSpreadRatio * trace * trace) {
    const double inverse_det = 1.0 / det;
    return {vv * inverse_det, -uv * inverse_det, uu * inverse_det};
  }
  // One direction only: S = trace * e e^T has the pseudo-inverse S / trace^2.
  if (!(trace > kRoundingSpreadRatio * (m.uu + m.vv)) || m.n < 2.0) return {};
  return {uu / (trace * trace), uv / (trace * trace), vv / (trace * trace)};
}

Eigen::Vector3d regressInverseDepth(const TileMoments& m) {
  const TangentScatterInverse inverse = invertTangentScatter(m);
  const double inverse_n = 1.0 / m.n;
  const double qu = m.qu - m.u * m.q * inverse_n;
  const double qv = m.qv - m.v * m.q * inverse_n;
  const double alpha = inverse.uu * qu + inverse.uv * qv;
  const double beta = inverse.uv * qu + inverse.vv * qv;
  return {alpha, beta, (m.q - alpha * m.u - beta * m.v) * inverse_n};
}

double rootMeanSquare(const TileMoments& m, const Eigen::Vector3d& plane) {
  // Residuals of a regression are orthogonal to it.
  const double squares = m.qq - plane.dot(Eigen::Vector3d(m.qu, m.qv, m.q));
  return std::sqrt(std::max(0.0, squares / m.n));
}

}  // namespace planecloud

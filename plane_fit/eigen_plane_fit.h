// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Eigenvalues>

#include "planecloud_slam/plane_fit/plane_regression.h"

namespace planecloud {

/// The paper's fit, kept as the reference of the tests: the eigenvector of the smallest eigenvalue
/// of the 4x4 scatter matrix (paper eq. (4)) of (u, v, 1, q'), q' the inverse depth in a unit of
/// length of `unit` metres. In millimetres (0.001) it equals the regression, in metres it drifts
/// towards total least squares. Returns (alpha, beta, gamma) of q = alpha u + beta v + gamma [1/m].
[[nodiscard]] inline Eigen::Vector3d fitSmallestEigenvector(const TileMoments& m, double unit) {
  Eigen::Matrix4d scatter;
  scatter << m.uu, m.uv, m.u, m.qu * unit,  //
      m.uv, m.vv, m.v, m.qv * unit,         //
      m.u, m.v, m.n, m.q * unit,            //
      m.qu * unit, m.qv * unit, m.q * unit, m.qq * unit * unit;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> solver(scatter);
  const Eigen::Vector4d abcd = solver.eigenvectors().col(0);
  return -abcd.head<3>() / (abcd(3) * unit);
}

}  // namespace planecloud

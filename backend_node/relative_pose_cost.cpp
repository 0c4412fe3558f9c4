// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/backend_node/relative_pose_cost.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>

namespace planecloud {
namespace {

/// Below this angle [rad] series replace the closed forms, which cancel.
constexpr double kSeriesAngle = 0.05;

/// Eigenvalues below this share of the largest are rounding errors.
constexpr double kRoundingShare = 1e-12;

/// A pivot of Cholesky's factor above this share of the largest is no rounding error.
constexpr double kSurePivot = 1e-5;

/// Inverse of the left Jacobian of SE(3) at `xi` (Barfoot, State Estimation for Robotics,
/// eq. (7.86) and (7.95)).
Matrix6d leftJacobianInverse(const Vector6d& xi) {
  const Eigen::Matrix3d P = skew(xi.head<3>());
  const Eigen::Matrix3d Phi = skew(xi.tail<3>());
  const double a = xi.tail<3>().norm();
  const double a2 = a * a;
  double c1 = 0.5 - a2 / 24.0;
  double c2 = 1.0 / 6.0 - a2 / 120.0;
  double c3 = 1.0 / 24.0 - a2 / 720.0;
  double c4 = 1.0 / 120.0 - a2 / 2520.0;
  if (a >= kSeriesAngle) {
    const double s = std::sin(a);
    const double c = std::cos(a);
    c1 = (1.0 - c) / a2;
    c2 = (a - s) / (a2 * a);
    c3 = (a2 + 2.0 * c - 2.0) / (2.0 * a2 * a2);
    c4 = (2.0 * a - 3.0 * s + a * c) / (2.0 * a2 * a2 * a);
  }
  const Eigen::Matrix3d Phi2 = Phi * Phi;
  const Eigen::Matrix3d PhiPPhi = Phi * P * Phi;
  const Eigen::Matrix3d Q = 0.5 * P + c2 * (Phi * P + P * Phi + PhiPPhi) +
                            c3 * (Phi2 * P + P * Phi2 - 3.0 * PhiPPhi) +
                            c4 * (PhiPPhi * Phi + Phi * PhiPPhi);
  const Eigen::Matrix3d J = Eigen::Matrix3d::Identity() + c1 * Phi + c2 * Phi2;
  const Eigen::Matrix3d J_inverse = J.inverse();
  Matrix6d result = Matrix6d::Zero();
  result.topLeftCorner<3, 3>() = J_inverse;
  result.bottomRightCorner<3, 3>() = J_inverse;
  result.topRightCorner<3, 3>() = -J_inverse * Q * J_inverse;
  return result;
}

}  // namespace

Matrix6d squareRootInformation(const Matrix6d& information) {
  // Most measurements observe everything: Cholesky takes a twentieth of the time of the other way.
  const Eigen::LLT<Matrix6d> factor(information);
  const Vector6d pivots = factor.matrixLLT().diagonal();
  if (factor.info() == Eigen::Success && pivots.minCoeff() > kSurePivot * pivots.maxCoeff()) {
    return factor.matrixU();
  }
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(information);
  const double largest = std::max(solver.eigenvalues().maxCoeff(), 0.0);
  Vector6d roots = Vector6d::Zero();
  for (int i = 0; i < 6; ++i) {
    const double value = solver.eigenvalues()[i];
    if (value > kRoundingShare * largest) roots[i] = std::sqrt(value);
  }
  return roots.asDiagonal() * solver.eigenvectors().transpose();
}

Matrix6d withErrorFloor(const Matrix6d& information, double translation, double rotation) {
  // (I^-1 + E)^-1 = S^T (1 + S E S^T)^-1 S, which needs no inverse of I = S^T S.
  Vector6d variances;
  variances.head<3>().setConstant(translation * translation);
  variances.tail<3>().setConstant(rotation * rotation);
  const Matrix6d S = squareRootInformation(information);
  const Matrix6d inner = Matrix6d::Identity() + S * variances.asDiagonal() * S.transpose();
  const Matrix6d result = S.transpose() * inner.ldlt().solve(S);
  return 0.5 * (result + result.transpose());
}

RelativePoseCost::RelativePoseCost(const Eigen::Isometry3d& T_from_to, const Matrix6d& information)
    : T_to_from_(T_from_to.inverse()),
      square_root_information_(squareRootInformation(information)) {}

Vector6d RelativePoseCost::residual(const Eigen::Isometry3d& T_map_from,
                                    const Eigen::Isometry3d& T_map_to) const {
  return square_root_information_ * logSe3(T_to_from_ * T_map_from.inverse() * T_map_to);
}

RelativePoseCost::Linearisation RelativePoseCost::linearise(
    const Eigen::Isometry3d& T_map_from, const Eigen::Isometry3d& T_map_to) const {
  const Eigen::Isometry3d T_from_to = T_map_from.inverse() * T_map_to;
  const Vector6d error = logSe3(T_to_from_ * T_from_to);
  // Log(E Exp(xi)) = Log(E) + Jr^-1 xi with Jr(e) = Jl(-e); a perturbation at `from` reaches `to`
  // by the adjoint: Exp(-xi) T_from_to = T_from_to Exp(-Ad(T_to_from) xi).
  const Matrix6d by_to = square_root_information_ * leftJacobianInverse(-error);
  return {square_root_information_ * error, -by_to * adjoint(T_from_to.inverse()), by_to};
}

}  // namespace planecloud

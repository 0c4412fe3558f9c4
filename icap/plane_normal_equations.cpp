// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/icap/plane_normal_equations.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <array>
#include <cstddef>

#include "planecloud_slam/icap/match_sums.h"

namespace planecloud {
namespace {

/// Symmetric from its upper half, row after row.
template <int Size>
Eigen::Matrix<double, Size, Size> symmetric(const std::array<double, Size*(Size + 1) / 2>& upper) {
  Eigen::Matrix<double, Size, Size> full;
  std::size_t entry = 0;
  for (Eigen::Index row = 0; row < Size; ++row) {
    for (Eigen::Index column = row; column < Size; ++column) {
      full(row, column) = full(column, row) = upper[entry++];
    }
  }
  return full;
}

PlaneNormalEquations finish(const MatchSums& sums) {
  const Eigen::Matrix3d identity = Eigen::Matrix3d::Identity();
  PlaneNormalEquations system;
  system.hessian = symmetric<6>(sums.hessian);
  system.hessian.bottomRightCorner<3, 3>() += sums.weight * identity - symmetric<3>(sums.dyads);
  system.gradient = Eigen::Map<const Vector6d>(sums.gradient.data());
  // Across its normal a point's motion under a twist, [I, -[p]x], turns into distance by the
  // error of the normal: sum of s M^T (I - n n^T) M.
  const Eigen::Matrix3d spread_points =
      skew(Eigen::Map<const Eigen::Vector3d>(sums.spread_point.data()));
  const Eigen::Matrix3d spread_square = symmetric<3>(sums.spread_square);
  system.noise.topLeftCorner<3, 3>() = sums.spread * identity;
  system.noise.topRightCorner<3, 3>() = -spread_points;
  system.noise.bottomLeftCorner<3, 3>() = spread_points;
  system.noise.bottomRightCorner<3, 3>() = spread_square.trace() * identity - spread_square;
  system.noise -= symmetric<6>(sums.spread_along);
  system.noise.bottomRightCorner<3, 3>() +=
      sums.weight_variance * identity + symmetric<3>(sums.dyads_variance);
  system.weighted_error = sums.weighted_error;
  system.weight = sums.kernel_weight;
  system.squared_distance = sums.squared_distance;
  return system;
}

}  // namespace

PlaneNormalEquations buildNormalEquations(const std::vector<PatchMatch>& matches,
                                          const Eigen::Isometry3d& T_target_source,
                                          double kernel_width, const IcapOptions& options) {
  MatchWeighing weighing;
  weighing.distance_floor = options.distance_floor;
  weighing.normal_floor = options.normal_floor;
  weighing.kernel_width = kernel_width;
  return finish(sumMatches(matches, T_target_source.inverse(), weighing));
}

Observability analyseObservability(const PlaneNormalEquations& system, double factor) {
  // The noise makes a natural unit for every direction: moving the patches by their own errors.
  const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix6d> eigen(system.hessian, system.noise);
  const Eigen::Index dark = (eigen.eigenvalues().array() < factor).count();
  Observability result;
  // Eigenvalues ascend: the first `dark` eigenvectors span what is not observed.
  const Matrix6d basis =
      Eigen::Matrix<double, 6, Eigen::Dynamic>(eigen.eigenvectors().leftCols(dark))
          .householderQr()
          .householderQ();
  result.unobserved = basis.leftCols(dark);
  result.observed = basis.rightCols(6 - dark);
  return result;
}

Vector6d leastObserved(const PlaneNormalEquations& system) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix6d> eigen(system.hessian, system.noise);
  return eigen.eigenvectors().col(0).normalized();
}

Vector6d solveObserved(const PlaneNormalEquations& system, const Observability& observability) {
  const Eigen::Matrix<double, 6, Eigen::Dynamic>& basis = observability.observed;
  if (basis.cols() == 0) return Vector6d::Zero();
  const Eigen::MatrixXd reduced = basis.transpose() * system.hessian * basis;
  return -basis * reduced.ldlt().solve(basis.transpose() * system.gradient);
}

}  // namespace planecloud

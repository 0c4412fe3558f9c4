// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <random>

#include "planecloud_slam/backend_node/relative_pose_cost.h"

namespace planecloud {
namespace {

Vector6d randomTwist(std::mt19937& generator, double translation, double rotation) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Vector6d xi;
  for (int i = 0; i < 6; ++i) xi[i] = (i < 3 ? translation : rotation) * uniform(generator);
  return xi;
}

/// Not diagonal, so that a transposed square root cannot pass.
Matrix6d randomInformation(std::mt19937& generator, int rank) {
  Matrix6d information = Matrix6d::Zero();
  for (int i = 0; i < rank; ++i) {
    const Vector6d direction = randomTwist(generator, 1.0, 1.0);
    information += 100.0 * direction * direction.transpose();
  }
  return information;
}

TEST(SquareRootInformation, SquaresToTheInformationOfAnyRank) {
  std::mt19937 generator(1);
  for (int rank = 0; rank <= 6; ++rank) {
    const Matrix6d information = randomInformation(generator, rank);
    const Matrix6d S = squareRootInformation(information);
    EXPECT_LT((S.transpose() * S - information).norm(), 1e-9) << "rank " << rank;
  }
}

TEST(SquareRootInformation, TreatsRoundingBelowZeroAsNoInformation) {
  Matrix6d information = Matrix6d::Identity();
  information(2, 2) = -1e-14;
  const Matrix6d S = squareRootInformation(information);
  EXPECT_TRUE(S.allFinite());
  EXPECT_LT(S.col(2).norm(), 1e-12);
}

TEST(WithErrorFloor, AddsVariancesOfADiagonalMatrix) {
  const Matrix6d result = withErrorFloor(Matrix6d::Identity() * 1e4, 0.01, 0.02);
  EXPECT_NEAR(result(0, 0), 1.0 / (1e-4 + 1e-4), 1e-6);
  EXPECT_NEAR(result(5, 5), 1.0 / (1e-4 + 4e-4), 1e-6);
}

TEST(WithErrorFloor, KeepsDirectionsWithoutInformation) {
  std::mt19937 generator(2);
  const Matrix6d information = randomInformation(generator, 4);
  const Matrix6d result = withErrorFloor(information, 0.01, 0.01);
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(information);
  for (int i = 0; i < 2; ++i) {
    EXPECT_LT((result * solver.eigenvectors().col(i)).norm(), 1e-6);
  }
  EXPECT_LT(result.trace(), information.trace());
}

TEST(RelativePoseCost, IsZeroWhereTheMeasurementHolds) {
  std::mt19937 generator(3);
  const Eigen::Isometry3d T_map_from = expSe3(randomTwist(generator, 5.0, 1.5));
  const Eigen::Isometry3d T_from_to = expSe3(randomTwist(generator, 1.0, 1.0));
  const RelativePoseCost cost(T_from_to, randomInformation(generator, 6));
  EXPECT_LT(cost.residual(T_map_from, T_map_from * T_from_to).norm(), 1e-9);
}

TEST(RelativePoseCost, MeasuresInTheTangentSpaceAtItsSecondPose) {
  std::mt19937 generator(4);
  const Matrix6d information = randomInformation(generator, 6);
  const Eigen::Isometry3d T_from_to = expSe3(randomTwist(generator, 1.0, 1.0));
  const Vector6d xi = randomTwist(generator, 0.3, 0.3);
  const RelativePoseCost cost(T_from_to, information);
  const double error =
      cost.residual(Eigen::Isometry3d::Identity(), T_from_to * expSe3(xi)).squaredNorm();
  EXPECT_NEAR(error, xi.dot(information * xi), 1e-9 * error);
}

/// Central differences over the right perturbation of one of the poses.
Matrix6d differences(const RelativePoseCost& cost, const Eigen::Isometry3d& T_map_from,
                     const Eigen::Isometry3d& T_map_to, bool by_from) {
  constexpr double kStep = 1e-6;
  Matrix6d jacobian;
  for (int i = 0; i < 6; ++i) {
    const Eigen::Isometry3d forth = expSe3(kStep * Vector6d::Unit(i));
    const Eigen::Isometry3d back = forth.inverse();
    const Vector6d after = by_from ? cost.residual(T_map_from * forth, T_map_to)
                                   : cost.residual(T_map_from, T_map_to * forth);
    const Vector6d before = by_from ? cost.residual(T_map_from * back, T_map_to)
                                    : cost.residual(T_map_from, T_map_to * back);
    jacobian.col(i) = (after - before) / (2.0 * kStep);
  }
  return jacobian;
}

TEST(RelativePoseCost, DerivativesEqualDifferencesForSmallAndLargeErrors) {
  std::mt19937 generator(5);
  for (const double size : {0.0, 1e-4, 0.02, 0.049, 0.051, 0.5, 1.2}) {
    const Eigen::Isometry3d T_map_from = expSe3(randomTwist(generator, 3.0, 1.0));
    const Eigen::Isometry3d T_from_to = expSe3(randomTwist(generator, 1.0, 1.0));
    const Eigen::Isometry3d T_map_to =
        T_map_from * T_from_to * expSe3(randomTwist(generator, size, size));
    const RelativePoseCost cost(T_from_to, randomInformation(generator, 6));
    const RelativePoseCost::Linearisation linear = cost.linearise(T_map_from, T_map_to);
    EXPECT_LT((linear.residual - cost.residual(T_map_from, T_map_to)).norm(), 1e-12);
    const Matrix6d by_from = differences(cost, T_map_from, T_map_to, true);
    const Matrix6d by_to = differences(cost, T_map_from, T_map_to, false);
    // Differences of step 1e-6 are good to about 1e-9 of the entries.
    EXPECT_LT((linear.by_from - by_from).norm(), 1e-7 * by_from.norm()) << "size " << size;
    EXPECT_LT((linear.by_to - by_to).norm(), 1e-7 * by_to.norm()) << "size " << size;
  }
}

}  // namespace
}  // namespace planecloud

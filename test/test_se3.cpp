// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "planecloud_slam/plane_fit/se3.h"

namespace planecloud {
namespace {

Vector6d randomTwist(std::mt19937& random, double translation, double rotation) {
  std::normal_distribution<double> normal;
  Vector6d xi;
  for (int i = 0; i < 6; ++i) xi(i) = normal(random) * (i < 3 ? translation : rotation);
  return xi;
}

TEST(Se3, TranslationComesFirst) {
  Vector6d xi = Vector6d::Zero();
  xi(0) = 1.0;
  EXPECT_TRUE(expSe3(xi).translation().isApprox(Eigen::Vector3d::UnitX()));
  EXPECT_TRUE(expSe3(xi).linear().isIdentity());
}

TEST(Se3, LogInvertsExpFromTinyToLargeAngles) {
  std::mt19937 random(1);
  for (const double angle : {1e-9, 1e-6, 1e-3, 0.3, 1.0}) {
    for (int i = 0; i < 50; ++i) {
      const Vector6d xi = randomTwist(random, 2.0, angle);
      if (xi.tail<3>().norm() > 3.1) continue;
      EXPECT_LT((logSe3(expSe3(xi)) - xi).norm(), 1e-9) << xi.transpose();
    }
  }
}

TEST(Se3, LogIsFiniteAtHalfATurn) {
  Vector6d xi = Vector6d::Zero();
  xi(4) = M_PI;
  xi(0) = 1.0;
  const Vector6d log = logSe3(expSe3(xi));
  EXPECT_NEAR(log.tail<3>().norm(), M_PI, 1e-9);
  EXPECT_TRUE(expSe3(log).isApprox(expSe3(xi), 1e-9));
}

TEST(Se3, AdjointMovesATwistThroughAPose) {
  std::mt19937 random(2);
  for (int i = 0; i < 50; ++i) {
    const Eigen::Isometry3d T = expSe3(randomTwist(random, 1.0, 0.7));
    const Vector6d xi = randomTwist(random, 0.2, 0.2);
    EXPECT_TRUE((T * expSe3(xi)).isApprox(expSe3(adjoint(T) * xi) * T, 1e-9));
  }
}

TEST(Se3, InvertedInformationGivesTheSameSquaredError) {
  std::mt19937 random(3);
  const Eigen::Isometry3d T = expSe3(randomTwist(random, 1.0, 0.7));
  const Matrix6d root = Matrix6d::Random();
  const Matrix6d information = root.transpose() * root;
  const Vector6d xi = 1e-6 * randomTwist(random, 1.0, 1.0);
  const Eigen::Isometry3d T_moved = T * expSe3(xi);
  const Vector6d xi_inverse = logSe3(T * T_moved.inverse());
  const double forward = xi.dot(information * xi);
  const double backward =
      xi_inverse.dot(invertRelativePoseInformation(T, information) * xi_inverse);
  EXPECT_NEAR(forward / backward, 1.0, 1e-4);
}

}  // namespace
}  // namespace planecloud

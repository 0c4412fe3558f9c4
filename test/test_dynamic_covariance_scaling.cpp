// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "planecloud_slam/backend_node/dynamic_covariance_scaling.h"

namespace planecloud {
namespace {

struct Rho {
  explicit Rho(double square) { DynamicCovarianceScaling(3.0).Evaluate(square, values); }
  double values[3];
};

TEST(DynamicCovarianceScaling, SmallErrorsCountAsTheyAre) {
  for (const double square : {0.0, 1.0, 9.0}) {
    EXPECT_EQ(Rho(square).values[0], square);
    EXPECT_EQ(Rho(square).values[1], 1.0);
  }
}

TEST(DynamicCovarianceScaling, DerivativesAreThoseOfTheValue) {
  for (const double square : {9.0 + 1e-3, 12.0, 50.0, 1e4}) {
    const double h = 1e-5 * square;
    const Rho before(square - h), at(square), after(square + h);
    EXPECT_NEAR(at.values[1], (after.values[0] - before.values[0]) / (2 * h), 1e-6);
    EXPECT_NEAR(at.values[2], (after.values[1] - before.values[1]) / (2 * h), 1e-6);
  }
}

TEST(DynamicCovarianceScaling, LargeErrorsPullWithTheSquareOfTheScale) {
  const double square = 900.0;  // thirty sigma
  const double scale = 2.0 * 9.0 / (9.0 + square);
  EXPECT_NEAR(Rho(square).values[1], scale * scale, 1e-12);
  EXPECT_LT(Rho(1e9).values[0], 3.0 * 9.0);  // bounded: one false edge costs no more than this
}

}  // namespace
}  // namespace planecloud

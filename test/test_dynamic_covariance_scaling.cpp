// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "planecloud_slam/backend_node/dynamic_covariance_scaling.h"

namespace planecloud {
namespace {

constexpr double kWidth = 3.0;  // [sigma]

KernelValue at(double square) { return dynamicCovarianceScaling(square, kWidth); }

TEST(DynamicCovarianceScaling, SmallErrorsCountAsTheyAre) {
  for (const double square : {0.0, 1.0, 9.0}) {
    EXPECT_EQ(at(square).value, square);
    EXPECT_EQ(at(square).slope, 1.0);
  }
}

TEST(DynamicCovarianceScaling, DerivativesAreThoseOfTheValue) {
  for (const double square : {9.0 + 1e-3, 12.0, 50.0, 1e4}) {
    const double h = 1e-5 * square;
    const KernelValue before = at(square - h), after = at(square + h);
    EXPECT_NEAR(at(square).slope, (after.value - before.value) / (2 * h), 1e-6);
    EXPECT_NEAR(at(square).curvature, (after.slope - before.slope) / (2 * h), 1e-6);
  }
}

TEST(DynamicCovarianceScaling, LargeErrorsPullWithTheSquareOfTheScale) {
  const double square = 900.0;  // thirty sigma
  const double scale = 2.0 * 9.0 / (9.0 + square);
  EXPECT_NEAR(at(square).slope, scale * scale, 1e-12);
  EXPECT_LT(at(1e9).value, 3.0 * 9.0);  // bounded: one false edge costs no more than this
}

}  // namespace
}  // namespace planecloud

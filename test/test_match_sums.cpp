// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "planecloud_slam/icap/match_sums.h"
#include "planecloud_slam/icap/plane_set.h"
#include "synthetic_planes.h"

namespace planecloud {
namespace {

constexpr double kNoise = 1.6e-3;  // inverse depth of one pixel [1/m]

Eigen::Isometry3d roomPose() { return lookAlongX({-1.8, -0.3, 1.2}, 0.1, 0.1); }

/// Same numbers within `tolerance` of the largest.
template <std::size_t Size>
void expectNear(const std::array<double, Size>& a, const std::array<double, Size>& b,
                double tolerance) {
  double largest = 0.0;
  for (const double value : b) largest = std::max(largest, std::abs(value));
  for (std::size_t i = 0; i < Size; ++i) EXPECT_NEAR(a[i], b[i], tolerance * largest) << i;
}

TEST(MatchSums, VectorsSumLikeDoublesOneByOne) {
  std::mt19937 random(1);
  const PlaneSet target(makeRoom().view(roomPose(), kNoise, 1));
  const PlaneSet source(makeRoom().view(roomPose(), kNoise, 2));
  const Eigen::Isometry3d T = randomMotion(0.05, 0.03, random);
  std::vector<PatchMatch> matches = matchInView(target, source, T, MatchGates(), 1000);
  ASSERT_GT(matches.size(), 300U);
  // Whole blocks of vectors and the rest of one.
  for (const std::size_t count :
       {matches.size(), std::size_t{33}, std::size_t{16}, std::size_t{1}}) {
    matches.resize(count);
    const MatchSums found = sumMatches(matches, T.inverse(), MatchWeighing());
    const MatchSums expected = sumMatchesScalar(matches, T.inverse(), MatchWeighing());
    // Single precision; the gradient is a small sum of large numbers.
    constexpr double kTolerance = 1e-5;
    expectNear(found.hessian, expected.hessian, kTolerance);
    expectNear(found.spread_along, expected.spread_along, kTolerance);
    expectNear(found.gradient, expected.gradient, 1e-3);
    expectNear(found.spread_point, expected.spread_point, kTolerance);
    expectNear(found.spread_square, expected.spread_square, kTolerance);
    expectNear(found.dyads, expected.dyads, kTolerance);
    expectNear(found.dyads_variance, expected.dyads_variance, kTolerance);
    const auto scalars = [](const MatchSums& sums) {
      return std::array<double, 3>{sums.spread, sums.weight, sums.weight_variance};
    };
    expectNear(scalars(found), scalars(expected), kTolerance);
    EXPECT_NEAR(found.kernel_weight, expected.kernel_weight, kTolerance * expected.kernel_weight);
    EXPECT_NEAR(found.weighted_error, expected.weighted_error, 1e-4 * expected.weighted_error);
    EXPECT_NEAR(found.squared_distance, expected.squared_distance,
                1e-4 * expected.squared_distance);
  }
}

TEST(MatchSums, OfNothingAreZero) {
  const MatchSums sums = sumMatches({}, Eigen::Isometry3d::Identity(), MatchWeighing());
  EXPECT_EQ(sums.hessian, MatchSums().hessian);
  EXPECT_EQ(sums.kernel_weight, 0.0);
}

}  // namespace
}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "planecloud_slam/frontend_node/robust_weight.h"

namespace planecloud {
namespace {

struct Samples {
  std::vector<float> grey, q, seen;
  [[nodiscard]] ResidualView view() const { return {grey.data(), q.data(), seen.data(), q.size()}; }
};

/// Bivariate t samples with 5 degrees of freedom: q of scale 0.05, grey 4 around 20 q.
Samples drawSamples(double outliers) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  std::chi_squared_distribution<double> chi(5.0);
  std::uniform_real_distribution<double> uniform;
  Samples samples;
  for (int i = 0; i < 40000; ++i) {
    const double stretch = 1.0 / std::sqrt(chi(random) / 5.0);
    const bool outlier = uniform(random) < outliers;
    const double q = 0.05 * stretch * normal(random);
    const double grey = 20.0 * q + 4.0 * stretch * normal(random);
    samples.q.push_back(static_cast<float>(outlier ? 5.0 : q));
    samples.grey.push_back(static_cast<float>(outlier ? 200.0 : grey));
    samples.seen.push_back(1.0F);
  }
  return samples;
}

ResidualScale estimate(const Samples& samples, const ScaleModel& model) {
  ResidualScale scale{30.0, 1.0, 0.0};
  for (int pass = 0; pass < 30; ++pass) scale = reestimateScale(samples.view(), scale, model);
  return scale;
}

TEST(RobustWeight, FindsTheScaleOfTDistributedResiduals) {
  const ResidualScale scale = estimate(drawSamples(0.0), {5.0, 0.1, 1e-4});
  EXPECT_NEAR(scale.sigma_q, 0.05, 0.001);  // 40000 samples: standard error below 1 %
  EXPECT_NEAR(scale.sigma_grey, 4.0, 0.08);
  EXPECT_NEAR(scale.slope, 20.0, 1.5);
}

TEST(RobustWeight, OneOutlierInTenHardlyMovesTheScale) {
  const ResidualScale scale = estimate(drawSamples(0.1), {5.0, 0.1, 1e-4});
  EXPECT_LT(scale.sigma_q, 2.0 * 0.05);
}

TEST(RobustWeight, PerfectResidualsKeepTheLeastScale) {
  Samples samples;
  samples.grey.assign(800, 0.0F);
  samples.q.assign(800, 0.0F);
  samples.seen.assign(800, 1.0F);
  const ResidualScale scale = estimate(samples, {5.0, 0.5, 0.02});
  EXPECT_DOUBLE_EQ(scale.sigma_grey, 0.5);
  EXPECT_DOUBLE_EQ(scale.sigma_q, 0.02);
}

TEST(RobustWeight, UnseenPointsDoNotCount) {
  Samples samples = drawSamples(0.0);
  const ResidualScale before = estimate(samples, {5.0, 0.1, 1e-4});
  for (int i = 0; i < 8000; ++i) {
    samples.grey.push_back(0.0F);
    samples.q.push_back(0.0F);
    samples.seen.push_back(0.0F);
  }
  EXPECT_DOUBLE_EQ(estimate(samples, {5.0, 0.1, 1e-4}).sigma_q, before.sigma_q);
}

TEST(RobustWeight, VectorAndScalarLoopsAgreeToRounding) {
  const Samples samples = drawSamples(0.1);
  const Whitening whitening = makeWhitening({5.0, 0.06, 15.0}, 5.0);
  const ScatterSums scalar = sumScatterScalar(samples.view(), whitening);
  const ScatterSums vector = sumScatterVector(samples.view(), whitening);
  // Float sums of 512 terms a lane.
  EXPECT_EQ(scalar.seen, vector.seen);
  EXPECT_NEAR(scalar.grey_grey, vector.grey_grey, 1e-5 * scalar.grey_grey);
  EXPECT_NEAR(scalar.q_q, vector.q_q, 1e-5 * scalar.q_q);
  EXPECT_NEAR(scalar.grey_q, vector.grey_q, 1e-5 * std::sqrt(scalar.grey_grey * scalar.q_q));
}

}  // namespace
}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "planecloud_slam/plane_fit/noise_model.h"

namespace planecloud {
namespace {

TEST(DepthNoiseModel, GrowsWithTheSquareOfDepth) {
  const DepthNoiseModel model;
  EXPECT_DOUBLE_EQ(model.depthStep(1.0), 2.8e-3);
  EXPECT_DOUBLE_EQ(model.depthStep(4.0), 16.0 * 2.8e-3);
  EXPECT_DOUBLE_EQ(model.depthSigma(3.0), 9.0 * model.inverseDepthSigma());
}

TEST(DepthNoiseModel, CountsTheQuantisation) {
  DepthNoiseModel model;
  model.disparity_noise = 0.0;
  EXPECT_NEAR(model.inverseDepthSigma(), 2.8e-3 / 3.4641, 1e-7);
}

TEST(DepthNoiseModel, RefusesValuesOutOfRangeByName) {
  DepthNoiseModel model;
  model.disparity_step = 0.0;
  EXPECT_THROW(model.check(), std::invalid_argument);
  model = {};
  model.disparity_noise = -1.0;
  EXPECT_THROW(model.check(), std::invalid_argument);
}

}  // namespace
}  // namespace planecloud

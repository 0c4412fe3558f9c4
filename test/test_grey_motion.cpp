// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>

#include "planecloud_slam/frontend_node/grey_motion.h"
#include "planecloud_slam/plane_fit/se3.h"
#include "synthetic_scene.h"

namespace planecloud {
namespace {

using synthetic::pose;

const Eigen::Isometry3d kDepthCamera = pose(0, 0, 0, 0.05, 0.2, 0);
/// 10 ms at 0.5 m/s and 60 degrees/s.
const Eigen::Isometry3d kColorDepth = pose(0.004, -0.001, 0.003, 0.003, -0.01, 0.002);

/// Finest level of depth from one pose and colour from another.
RgbdLevel mixedLevel(const Eigen::Isometry3d& T_color_depth) {
  const RgbdFrame depth = synthetic::render(synthetic::camera(), kDepthCamera);
  const RgbdFrame color =
      synthetic::render(synthetic::camera(), kDepthCamera * T_color_depth.inverse());
  RgbdPyramid pyramid(synthetic::camera(), DenseTrackerOptions());
  pyramid.assign(color.grey.view(), depth.depth.view());
  return pyramid.levels().front();
}

/// Mean difference of grey within the image.
double difference(const RgbdLevel& a, const RgbdLevel& b) {
  double sum = 0.0;
  int count = 0;
  for (int y = 10; y < a.camera.height - 10; ++y) {
    for (int x = 10; x < a.camera.width - 10; ++x, ++count) {
      sum += std::abs(a.pixels(x, y).grey - b.pixels(x, y).grey);
    }
  }
  return sum / count;
}

TEST(GreyMotion, MovesColourToWhereDepthWasTaken) {
  const RgbdLevel at_once = mixedLevel(Eigen::Isometry3d::Identity());
  RgbdLevel moved = mixedLevel(kColorDepth);
  const double before = difference(at_once, moved);
  moveGrey(kColorDepth, greyOf(moved).view(), moved);
  EXPECT_GT(before, 5.0);
  EXPECT_LT(difference(at_once, moved), 0.15 * before);  // edges of the pillar; interpolation
}

TEST(GreyMotion, LeavesDepthAloneAndGreyWhereNothingMoved) {
  const RgbdLevel level = mixedLevel(Eigen::Isometry3d::Identity());
  RgbdLevel same = level;
  moveGrey(Eigen::Isometry3d::Identity(), greyOf(same).view(), same);
  for (std::size_t i = 0; i < level.pixels.size(); ++i) {
    ASSERT_EQ(same.pixels.begin()[i].inverse_depth, level.pixels.begin()[i].inverse_depth);
    ASSERT_NEAR(same.pixels.begin()[i].grey, level.pixels.begin()[i].grey, 0.2F) << i;
  }
}

TEST(GreyMotion, VectorAndScalarLoopsAgreeToRounding) {
  RgbdLevel level = mixedLevel(kColorDepth);
  level.camera.width = 317;  // not a multiple of a vector's length
  Image<float> grey(317, level.camera.height);
  for (std::size_t i = 0; i < grey.size(); ++i) grey.begin()[i] = level.pixels.begin()[i].grey;
  for (const Eigen::Isometry3d& T : {kColorDepth, pose(0, 0, 0, 0.5, 0, 0), pose(0, 0, -5)}) {
    const GreyMotion motion{T.linear().cast<float>(), T.translation().cast<float>(), level.camera};
    for (const int y : {0, 100, 239}) {
      std::vector<GreyDepth> scalar(level.pixels.row(y), level.pixels.row(y) + 317);
      std::vector<GreyDepth> vector = scalar;
      scalarMoveGreyRow()(motion, grey.view(), y, scalar.data());
      vectorMoveGreyRow()(motion, grey.view(), y, vector.data());
      for (std::size_t i = 0; i < scalar.size(); ++i) {
        ASSERT_NEAR(scalar[i].grey, vector[i].grey, 0.02F) << i;  // 1e-4 px times the gradient
        ASSERT_EQ(scalar[i].inverse_depth, vector[i].inverse_depth);
      }
    }
  }
}

}  // namespace
}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

#include "planecloud_slam/frontend_node/rgbd_pyramid.h"
#include "synthetic_scene.h"

namespace planecloud {
namespace {

TEST(RgbdPyramid, PixelCentresMoveByHalfAPixel) {
  const LevelCamera level = levelCamera(synthetic::camera(), 1);
  // The point between pixels 0 and 1 of the finer image is the centre of pixel 0 of the coarser.
  EXPECT_FLOAT_EQ(level.cx, 79.5F);
  EXPECT_FLOAT_EQ(level.fx, 142.5F);
  EXPECT_EQ(level.width, 160);
}

TEST(RgbdPyramid, AveragesGreyAndInverseDepthOfOneSurface) {
  RgbdPyramid pyramid(synthetic::camera(), DenseTrackerOptions{});
  RgbdFrame frame = synthetic::render(synthetic::camera(), synthetic::pose(0, 0, 0));
  frame.grey(10, 20) = 10, frame.grey(11, 20) = 20, frame.grey(10, 21) = 30;
  frame.grey(11, 21) = 40;
  pyramid.assign(frame.grey.view(), frame.depth.view());
  EXPECT_FLOAT_EQ(pyramid.levels()[1].pixels(5, 10).grey, 25.0F);
  EXPECT_NEAR(pyramid.levels()[1].pixels(5, 10).inverse_depth, 1.0F / frame.depth(10, 20), 1e-3F);
}

TEST(RgbdPyramid, NoDepthLiesBetweenTwoSurfaces) {
  RgbdPyramid pyramid(synthetic::camera(), DenseTrackerOptions{});
  Image<std::uint8_t> grey(320, 240, 100);
  Image<float> depth(320, 240, 4.0F);
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 161; ++x) depth(x, y) = 1.0F;
  }
  pyramid.assign(grey.view(), depth.view());
  for (const RgbdLevel& level : pyramid.levels()) {
    for (const GreyDepth& pixel : level.pixels) {
      EXPECT_TRUE(pixel.inverse_depth == 1.0F || pixel.inverse_depth == 0.25F)
          << pixel.inverse_depth;
    }
  }
}

TEST(RgbdPyramid, InvalidAndFarDepthsCountAsNone) {
  RgbdPyramid pyramid(synthetic::camera(), DenseTrackerOptions{});
  Image<std::uint8_t> grey(320, 240, 100);
  for (const float z : {std::numeric_limits<float>::quiet_NaN(), 0.0F, -1.0F, 50.0F,
                        std::numeric_limits<float>::infinity()}) {
    Image<float> depth(320, 240, z);
    pyramid.assign(grey.view(), depth.view());
    EXPECT_EQ(pyramid.levels()[0].pixels(7, 7).inverse_depth, 0.0F) << z;
    EXPECT_EQ(pyramid.levels()[2].pixels(7, 7).inverse_depth, 0.0F) << z;
  }
}

TEST(RgbdPyramid, FinestLevelFollowsTheOption) {
  CameraIntrinsics camera = synthetic::camera();
  camera.width = 1280;
  camera.height = 960;
  EXPECT_EQ(RgbdPyramid(camera, DenseTrackerOptions{}).levels().front().camera.width, 320);
  DenseTrackerOptions fine;
  fine.finest_width = 640;
  EXPECT_EQ(RgbdPyramid(camera, fine).levels().front().camera.width, 640);
}

TEST(RgbdPyramid, RefusesDistortionAndTooManyLevels) {
  CameraIntrinsics distorted = synthetic::camera();
  distorted.distortion[0] = 0.1;
  EXPECT_THROW(RgbdPyramid(distorted, DenseTrackerOptions{}), std::invalid_argument);
  DenseTrackerOptions deep;
  deep.levels = 6;
  EXPECT_THROW(RgbdPyramid(synthetic::camera(), deep), std::invalid_argument);
}

template <typename Row>
void expectSameBits(const Row& scalar, const Row& vector) {
  for (std::size_t i = 0; i < scalar.size(); ++i) {
    ASSERT_EQ(scalar[i].grey, vector[i].grey) << i;
    ASSERT_EQ(scalar[i].inverse_depth, vector[i].inverse_depth) << i;
  }
}

TEST(PyramidKernels, GiveTheSameBits) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> uniform(0.0F, 1.0F);
  constexpr int kMost = 41;
  std::vector<std::uint8_t> grey[2];
  std::vector<float> depth[2];
  std::vector<GreyDepth> level[2];
  for (int row = 0; row < 2; ++row) {
    for (int i = 0; i < 2 * kMost; ++i) {
      grey[row].push_back(static_cast<std::uint8_t>(255.0F * uniform(random)));
      float z = i % 11 < 6 ? 1.0F + 0.06F * uniform(random) : 9.0F * uniform(random);
      if (i % 5 == 0) z = i % 2 == 0 ? 0.0F : std::numeric_limits<float>::quiet_NaN();
      depth[row].push_back(z);
      level[row].push_back({255.0F * uniform(random), z > 0.0F ? 1.0F / z : 0.0F});
    }
  }
  const GreyRows grey_rows{grey[0].data(), grey[1].data()};
  for (const int count : {1, 7, 8, 16, kMost}) {
    std::vector<GreyDepth> a(static_cast<std::size_t>(count)), b(a.size());
    std::vector<float> mean(a.size()), mean_b(a.size());
    scalarPyramidKernels().halve_grey(grey_rows, count, mean.data());
    vectorPyramidKernels().halve_grey(grey_rows, count, mean_b.data());
    EXPECT_EQ(mean, mean_b);
    const DepthRows rows{depth[0].data(), depth[1].data(), mean.data()};
    scalarPyramidKernels().halve_depth(rows, {0.2F, 8.0F}, count, a.data());
    vectorPyramidKernels().halve_depth(rows, {0.2F, 8.0F}, count, b.data());
    expectSameBits(a, b);
    scalarPyramidKernels().halve_level(level[0].data(), level[1].data(), count, a.data());
    vectorPyramidKernels().halve_level(level[0].data(), level[1].data(), count, b.data());
    expectSameBits(a, b);
  }
}

}  // namespace
}  // namespace planecloud

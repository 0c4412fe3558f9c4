// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "planecloud_slam/frontend_node/half_remap_kernel.h"
#include "planecloud_slam/frontend_node/rectifier.h"
#include "synthetic_scene.h"

namespace planecloud {
namespace {

CameraIntrinsics distortedCamera() {
  CameraIntrinsics camera = synthetic::camera();
  camera.distortion = {0.2624, -0.9531, -0.0054, 0.0026, 1.1633};  // of a Kinect
  return camera;
}

/// Tangent u as grey and depth seen by the distorted camera, so that images tell their rays.
RgbdFrame rayImages(const Camera& camera) {
  RgbdFrame frame{1.0, Image<std::uint8_t>(320, 240), Image<float>(320, 240), {}};
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 320; ++x) {
      const float u = camera.tangentsX()(x, y);
      frame.grey(x, y) = static_cast<std::uint8_t>(std::lround(128.0F + 180.0F * u));
      frame.depth(x, y) = 2.0F + u;
    }
  }
  return frame;
}

TEST(Rectifier, PixelsShowTheRayOfTheUndistortedCamera) {
  const RgbdFrame rectified =
      Rectifier(distortedCamera()).rectify(rayImages(Camera(distortedCamera())));
  const Camera pinhole(distortedCamera().rectified());
  EXPECT_EQ(rectified.stamp, 1.0);
  for (int y = 10; y < 230; y += 20) {
    for (int x = 10; x < 310; x += 20) {
      const float u = pinhole.tangentsX()(x, y);
      // Grey is rounded twice; depth comes from the nearest pixel, half of 1/285 away.
      EXPECT_NEAR(rectified.grey(x, y), 128.0F + 180.0F * u, 1.1F);
      EXPECT_NEAR(rectified.depth(x, y), 2.0F + u, 0.0025F);
    }
  }
}

TEST(Rectifier, MakesNoDepthBetweenTwoSurfaces) {
  RgbdFrame frame{0.0, Image<std::uint8_t>(320, 240, 0), Image<float>(320, 240, 4.0F), {}};
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 150; ++x) frame.depth(x, y) = 1.0F;
  }
  for (const float z : Rectifier(distortedCamera()).rectify(frame).depth) {
    EXPECT_TRUE(z == 1.0F || z == 4.0F || std::isnan(z)) << z;
  }
}

TEST(Rectifier, HalfGreyIsTheMeanOfTheRectifiedPixels) {
  RgbdFrame frame{0.0, Image<std::uint8_t>(320, 240), Image<float>(320, 240, 1.0F), {}};
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 320; ++x) {
      const float wave = std::sin(0.8F * static_cast<float>(x)) * std::cos(static_cast<float>(y));
      frame.grey(x, y) = static_cast<std::uint8_t>(std::lround(128.0F + 120.0F * wave));
    }
  }
  const Rectifier rectifier(distortedCamera());
  const Image<std::uint8_t> full = rectifier.rectify(frame).grey;
  Image<float> half;
  rectifier.rectifyHalfGrey(frame.grey, half);
  ASSERT_EQ(half.width(), 160);
  ASSERT_EQ(half.height(), 120);
  for (int y = 10; y < 110; ++y) {  // what lies beyond the original image is made up
    for (int x = 10; x < 150; ++x) {
      const int sum = full(2 * x, 2 * y) + full(2 * x + 1, 2 * y) + full(2 * x, 2 * y + 1) +
                      full(2 * x + 1, 2 * y + 1);
      // Waves of 6 to 8 pixels change by 100 levels a pixel; positions are rounded to 1/32 px.
      EXPECT_NEAR(half(x, y), 0.25F * static_cast<float>(sum), 4.0F) << x << " " << y;
    }
  }
}

TEST(Rectifier, VectorAndScalarLoopsGiveTheSameBits) {
  constexpr int kWidth = 53;
  constexpr int kHeight = 7;
  std::mt19937 random(5);
  std::uniform_int_distribution<int> uniform(0, 1 << 20);
  std::vector<std::uint8_t> grey(kWidth * kHeight);
  for (std::uint8_t& value : grey) value = static_cast<std::uint8_t>(uniform(random));
  std::vector<std::int32_t> at;
  std::vector<std::uint8_t> right, down;
  for (std::size_t i = 0; i < 203; ++i) {
    at.push_back(uniform(random) % (kHeight - 2) * kWidth + uniform(random) % (kWidth - 3));
    right.push_back(static_cast<std::uint8_t>(uniform(random) % (kHalfRemapSteps + 1)));
    down.push_back(static_cast<std::uint8_t>(uniform(random) % (kHalfRemapSteps + 1)));
  }
  const HalfRemapRow row{at.data(), right.data(), down.data()};
  std::vector<float> scalar(at.size()), vector(at.size());
  scalarHalfRemap()({grey.data(), kWidth}, row, at.size(), scalar.data());
  vectorHalfRemap()({grey.data(), kWidth}, row, at.size(), vector.data());
  EXPECT_EQ(scalar, vector);
}

TEST(Rectifier, ItsCameraHasNoDistortion) {
  const Rectifier rectifier(distortedCamera());
  EXPECT_FALSE(rectifier.camera().hasDistortion());
  EXPECT_EQ(rectifier.camera().fx, distortedCamera().fx);
}

}  // namespace
}  // namespace planecloud

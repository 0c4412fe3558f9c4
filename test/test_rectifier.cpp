// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>

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

TEST(Rectifier, ItsCameraHasNoDistortion) {
  const Rectifier rectifier(distortedCamera());
  EXPECT_FALSE(rectifier.camera().hasDistortion());
  EXPECT_EQ(rectifier.camera().fx, distortedCamera().fx);
}

}  // namespace
}  // namespace planecloud

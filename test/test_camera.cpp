// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "planecloud_slam/plane_fit/camera.h"

namespace planecloud {
namespace {

CameraIntrinsics kinect() { return {640, 480, 517.3, 516.5, 318.6, 255.3, {}}; }

CameraIntrinsics distortedKinect() {
  CameraIntrinsics intrinsics = kinect();
  intrinsics.distortion = {0.2624, -0.9531, -0.0054, 0.0026, 1.1633};
  return intrinsics;
}

TEST(Camera, TangentsOfAPinholeAreLinear) {
  const Camera camera(kinect());
  EXPECT_NEAR(camera.tangentsX()(0, 100), -318.6 / 517.3, 1e-7);
  EXPECT_NEAR(camera.tangentsX()(639, 0), (639 - 318.6) / 517.3, 1e-7);
  EXPECT_NEAR(camera.tangentsY()(17, 479), (479 - 255.3) / 516.5, 1e-7);
}

TEST(Camera, ProjectionUndoesBackProjectionUnderDistortion) {
  const Camera camera(distortedKinect());
  for (int y = 0; y < 480; y += 37) {
    for (int x = 0; x < 640; x += 41) {
      const Eigen::Vector2d pixel = camera.project(camera.backProject(x, y, 2.5));
      // The tables hold floats: half an ulp of a tangent is 3e-8, times 517 px.
      EXPECT_NEAR(pixel.x(), x, 5e-5);
      EXPECT_NEAR(pixel.y(), y, 5e-5);
    }
  }
}

TEST(Camera, DistortionMovesTheCornersByPixelsAndTheCentreByNone) {
  const Camera ideal(kinect());
  const Camera real(distortedKinect());
  EXPECT_GT(std::abs(ideal.tangentsX()(0, 0) - real.tangentsX()(0, 0)), 1.0 / 517.3);
  EXPECT_NEAR(ideal.tangentsX()(319, 255), real.tangentsX()(319, 255), 0.01 / 517.3);
}

TEST(Camera, RefusesADistortionThatFoldsTheImage) {
  CameraIntrinsics intrinsics = kinect();
  intrinsics.distortion = {-3.0, 0.0, 0.0, 0.0, 0.0};
  EXPECT_THROW(Camera{intrinsics}, std::invalid_argument);
}

TEST(Camera, RefusesImpossibleIntrinsicsByName) {
  CameraIntrinsics intrinsics = kinect();
  intrinsics.fy = 0.0;
  try {
    intrinsics.check();
    FAIL() << "fy = 0 was accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "camera fy = 0: must be in [1, 100000]");
  }
  intrinsics = kinect();
  intrinsics.cx = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(intrinsics.check(), std::invalid_argument);
  intrinsics = kinect();
  intrinsics.width = 0;
  EXPECT_THROW(intrinsics.check(), std::invalid_argument);
}

TEST(Camera, RectifiedHasNoDistortion) {
  EXPECT_TRUE(distortedKinect().hasDistortion());
  EXPECT_FALSE(distortedKinect().rectified().hasDistortion());
  EXPECT_EQ(distortedKinect().rectified(), kinect());
}

}  // namespace
}  // namespace planecloud

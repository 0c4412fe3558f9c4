// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>

#include "planecloud_slam/frontend_node/plane_landmarks.h"
#include "planecloud_slam/frontend_node/tracking_reference.h"
#include "synthetic_scene.h"

namespace planecloud {
namespace {

using synthetic::pose;

constexpr double kNoise = 0.003;  // of inverse depth [1/m]

RgbdFrame noisyFrame() {
  synthetic::SceneOptions scene;
  scene.depth_noise = kNoise;
  return synthetic::render(synthetic::camera(), pose(0, 0, 0, 0.1, 0.2, 0), scene);
}

/// Inverse depth of the room at tangents (u, v).
double trueInverseDepth(float u, float v) {
  const Eigen::Isometry3d T = pose(0, 0, 0, 0.1, 0.2, 0);
  return 1.0 / synthetic::castRay(T.translation(), T.linear() * Eigen::Vector3d(u, v, 1.0));
}

double meanError(const ReferencePoints& points) {
  double sum = 0.0;
  for (std::size_t i = 0; i < points.count; ++i) {
    sum += std::abs(points.q[i] - trueInverseDepth(points.u[i], points.v[i]));
  }
  return sum / static_cast<double>(points.count);
}

TEST(PlaneLandmarks, KnowTheDepthOfARayBetterThanThePixel) {
  const RgbdFrame frame = noisyFrame();
  PlaneLandmarks planes(synthetic::camera(), QuadtreeFitterOptions());
  planes.assign(frame.depth.view());
  int found = 0;
  double error = 0.0;
  for (float v = -0.4F; v < 0.4F; v += 0.01F) {
    for (float u = -0.5F; u < 0.5F; u += 0.01F) {
      const Eigen::Vector3f* plane = planes.find(u, v);
      if (plane == nullptr) continue;
      ++found;
      error += std::abs(plane->dot(Eigen::Vector3f(u, v, 1.0F)) - trueInverseDepth(u, v));
    }
  }
  ASSERT_GT(found, 4000);                  // of 8000: all but the pillar's and the room's edges
  EXPECT_LT(error / found, 0.3 * kNoise);  // a pixel: 0.8 times the noise
}

TEST(PlaneLandmarks, AreNotFoundBeyondTheImageOrWithoutDepth) {
  PlaneLandmarks planes(synthetic::camera(), QuadtreeFitterOptions());
  EXPECT_EQ(planes.find(0.0F, 0.0F), nullptr);
  planes.assign(Image<float>(320, 240, std::nanf("")).view());
  EXPECT_EQ(planes.find(0.0F, 0.0F), nullptr);
  planes.assign(Image<float>(320, 240, 2.0F).view());
  ASSERT_NE(planes.find(0.0F, 0.0F), nullptr);
  EXPECT_NEAR(planes.find(0.0F, 0.0F)->z(), 0.5F, 1e-4F);
  EXPECT_EQ(planes.find(0.7F, 0.0F), nullptr);
  EXPECT_EQ(planes.find(0.0F, std::nanf("")), nullptr);
}

TEST(TrackingReference, TakesDepthFromPlanesThatAgree) {
  const RgbdFrame frame = noisyFrame();
  RgbdPyramid pyramid(synthetic::camera(), DenseTrackerOptions());
  pyramid.assign(frame.grey.view(), frame.depth.view());
  PlaneLandmarks planes(synthetic::camera(), QuadtreeFitterOptions());
  planes.assign(frame.depth.view());
  const TrackingReference windows(pyramid, DenseTrackerOptions());
  const TrackingReference landmarks(pyramid, DenseTrackerOptions(), {}, &planes);
  const ReferencePoints& finest = landmarks.levels().front();
  ASSERT_EQ(finest.count, windows.levels().front().count);
  EXPECT_LT(meanError(finest), 0.7 * meanError(windows.levels().front()));
}

TEST(TrackingReference, KeepsDepthThatDisagreesWithThePlane) {
  const RgbdFrame frame = noisyFrame();
  RgbdPyramid pyramid(synthetic::camera(), DenseTrackerOptions());
  pyramid.assign(frame.grey.view(), frame.depth.view());
  PlaneLandmarks wall(synthetic::camera(), QuadtreeFitterOptions());
  wall.assign(Image<float>(320, 240, 0.5F).view());
  const TrackingReference windows(pyramid, DenseTrackerOptions());
  const TrackingReference landmarks(pyramid, DenseTrackerOptions(), {}, &wall);
  EXPECT_EQ(landmarks.levels().front().q, windows.levels().front().q);
}

}  // namespace
}  // namespace planecloud

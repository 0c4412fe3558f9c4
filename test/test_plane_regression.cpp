// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <random>

#include "planecloud_slam/plane_fit/eigen_plane_fit.h"
#include "planecloud_slam/plane_fit/plane_regression.h"

namespace planecloud {
namespace {

constexpr double kPixel = 1.0 / 525.0;  // a pixel's tangent

/// Moments of a width x height tile at `offset` pixels from the axis, noise of `sigma` in q.
TileMoments sample(const Eigen::Vector3d& plane, int width, int height, double offset,
                   double sigma) {
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0.0, sigma);
  TileMoments moments;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const double u = (x + offset) * kPixel;
      const double v = (y - offset) * kPixel;
      const double q = plane.dot(Eigen::Vector3d(u, v, 1.0)) + (sigma > 0.0 ? noise(random) : 0.0);
      moments.add(u, v, q);
    }
  }
  return moments;
}

TEST(PlaneRegression, RecoversExactPlanes) {
  for (const Eigen::Vector3d& plane :
       {Eigen::Vector3d(0.0, 0.0, 0.5), Eigen::Vector3d(0.3, -0.2, 0.8),
        Eigen::Vector3d(-5.0, 2.0, 3.0)}) {
    for (const int side : {2, 4, 64}) {
      const Eigen::Vector3d fit = regressInverseDepth(sample(plane, side, side, 100.0, 0.0));
      EXPECT_LT((fit - plane).norm(), 1e-8) << side;
    }
  }
}

TEST(PlaneRegression, EqualsTheEigenvectorInMillimetres) {
  const Eigen::Vector3d plane(0.3, -0.2, 0.8);
  for (const int side : {8, 16, 64}) {
    const TileMoments moments = sample(plane, side, side, 30.0, 3e-3);
    const Eigen::Vector3d regression = regressInverseDepth(moments);
    const Eigen::Vector3d eigenvector = fitSmallestEigenvector(moments, 1e-3);
    // Total least squares differs from regression by (noise / spread)^2, both per millimetre.
    EXPECT_LT((regression - eigenvector).norm(), 1e-4 * regression.norm()) << side;
  }
}

TEST(PlaneRegression, DiffersFromTheEigenvectorInMetres) {
  const TileMoments moments = sample({0.3, -0.2, 0.8}, 8, 8, 30.0, 3e-3);
  const Eigen::Vector3d regression = regressInverseDepth(moments);
  EXPECT_GT((regression - fitSmallestEigenvector(moments, 1.0)).norm(), 1e-2);
}

TEST(PlaneRegression, LeavesTheDirectionFlatThatPixelsDoNotSpan) {
  const Eigen::Vector3d plane(0.3, -0.2, 0.8);
  const Eigen::Vector3d row = regressInverseDepth(sample(plane, 8, 1, 0.0, 0.0));
  EXPECT_NEAR(row.x(), 0.3, 1e-9);
  EXPECT_NEAR(row.y(), 0.0, 1e-9);
  const Eigen::Vector3d column = regressInverseDepth(sample(plane, 1, 8, 0.0, 0.0));
  EXPECT_NEAR(column.x(), 0.0, 1e-9);
  EXPECT_NEAR(column.y(), -0.2, 1e-9);
  const Eigen::Vector3d pixel = regressInverseDepth(sample(plane, 1, 1, 100.0, 0.0));
  EXPECT_NEAR(pixel.head<2>().norm(), 0.0, 1e-12);
  EXPECT_NEAR(pixel.z(), plane.dot(Eigen::Vector3d(100.0 * kPixel, -100.0 * kPixel, 1.0)), 1e-12);
}

TEST(PlaneRegression, OfMergedMomentsIsThatOfAllPixels) {
  TileMoments merged = sample({0.3, -0.2, 0.8}, 8, 8, 0.0, 3e-3);
  TileMoments all = merged;
  const TileMoments other = sample({-0.1, 0.4, 0.7}, 8, 8, 8.0, 0.0);
  merged += other;
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 8; ++x) {
      const double u = (x + 8.0) * kPixel;
      const double v = (y - 8.0) * kPixel;
      all.add(u, v, Eigen::Vector3d(-0.1, 0.4, 0.7).dot(Eigen::Vector3d(u, v, 1.0)));
    }
  }
  EXPECT_LT((regressInverseDepth(merged) - regressInverseDepth(all)).norm(), 1e-9);
}

}  // namespace
}  // namespace planecloud

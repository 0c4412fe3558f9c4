// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <stdexcept>

#include "planar_scene.h"
#include "planecloud_slam/plane_fit/quadtree_fitter.h"
#include "planecloud_slam/plane_fit/reconstruction.h"

namespace planecloud {
namespace {

PlaneCloud oneTile(const CameraIntrinsics& camera) {
  PlaneCloud cloud;
  cloud.camera = camera;
  PlanarTile tile;
  tile.rect = {64, 128, 64, 32};
  tile.inverse_depth << 0.1F, -0.2F, 0.5F;
  cloud.tiles = {tile};
  return cloud;
}

TEST(Reconstruction, DrawsDepthOnTheTilesAndNaNElsewhere) {
  const Camera camera(distortedTestCamera());
  const PlaneCloud cloud = oneTile(camera.intrinsics());
  const Image<float> expected = renderPlane(camera, cloud.tiles[0].inverse_depth);
  const Image<float> depth = reconstructDepth(cloud, camera);
  int drawn = 0;
  for (int y = 0; y < depth.height(); ++y) {
    for (int x = 0; x < depth.width(); ++x) {
      if (std::isnan(depth(x, y))) continue;
      ++drawn;
      ASSERT_NEAR(depth(x, y), expected(x, y), 1e-6);
    }
  }
  EXPECT_EQ(drawn, 64 * 32);
  EXPECT_FALSE(std::isnan(depth(64, 128)));
  EXPECT_TRUE(std::isnan(depth(63, 128)));
}

TEST(Reconstruction, InvertsTheFitOfAnExactScene) {
  const auto camera = std::make_shared<const Camera>(testCamera());
  const Image<float> depth = renderPlane(*camera, {0.2F, 0.1F, 0.6F});
  const PlaneCloud cloud = QuadtreeFitter(camera, {}).fit(depth.view());
  const Image<float> again = reconstructDepth(cloud, *camera);
  for (int y = 0; y < depth.height(); ++y) {
    for (int x = 0; x < depth.width(); ++x) ASSERT_NEAR(again(x, y), depth(x, y), 1e-5);
  }
}

TEST(Reconstruction, PointsLieOnTheirPlane) {
  const Camera camera(testCamera());
  const PlaneCloud cloud = oneTile(camera.intrinsics());
  const Eigen::Vector4d plane = cloud.tiles[0].plane();
  EXPECT_NEAR(plane.head<3>().norm(), 1.0, 1e-12);
  EXPECT_GT(plane(3), 0.0);
  for (const int step : {1, 3, 8}) {
    const auto points = reconstructPoints(cloud, camera, step);
    for (const Eigen::Vector3f& point : points) {
      ASSERT_NEAR(plane.head<3>().dot(point.cast<double>()) + plane(3), 0.0, 1e-6);
    }
  }
  EXPECT_EQ(reconstructPoints(cloud, camera, 1).size(), 64U * 32U);
  EXPECT_EQ(reconstructPoints(cloud, camera, 8).size(), 8U * 4U);
}

TEST(Reconstruction, PatchesOfNeighboursMeet) {
  const CameraIntrinsics camera = distortedTestCamera();
  PlanarTile left;
  left.rect = {64, 64, 64, 64};
  left.inverse_depth << 0.1F, -0.2F, 0.5F;
  PlanarTile right = left;
  right.rect.x = 128;
  const auto a = tileCorners(left, camera);
  const auto b = tileCorners(right, camera);
  ASSERT_TRUE(a && b);
  EXPECT_LT(((*a)[1] - (*b)[0]).norm(), 1e-9);
  EXPECT_LT(((*a)[2] - (*b)[3]).norm(), 1e-9);
  for (const Eigen::Vector3d& corner : *a) {
    EXPECT_NEAR(left.plane().head<3>().dot(corner) + left.plane()(3), 0.0, 1e-6);
  }
}

TEST(Reconstruction, GivesNoPatchBeyondTheDepthAskedFor) {
  PlanarTile tile;
  tile.rect = {64, 64, 64, 64};
  tile.inverse_depth << 0.0F, 0.0F, 0.2F;
  EXPECT_TRUE(tileCorners(tile, testCamera(), 5.1));
  EXPECT_FALSE(tileCorners(tile, testCamera(), 4.9));
}

TEST(Reconstruction, WantsTheCloudsOwnCamera) {
  const PlaneCloud cloud = oneTile(testCamera());
  EXPECT_THROW((void)reconstructDepth(cloud, Camera(distortedTestCamera())), std::invalid_argument);
  EXPECT_THROW((void)reconstructPoints(cloud, Camera(testCamera()), 0), std::invalid_argument);
}

}  // namespace
}  // namespace planecloud

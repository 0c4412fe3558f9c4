// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <random>
#include <stdexcept>

#include "planecloud_slam/icap/plane_set.h"
#include "synthetic_planes.h"

namespace planecloud {
namespace {

using Level = PlaneSet::Level;

/// One wall 2 m ahead, seen squarely, no noise: 300 tiles of 32 px.
PlaneCloud squareWall() {
  const SyntheticPlanes wall({{{2.0, 0.0, 0.0}, {0.0, 20.0, 0.0}, {0.0, 0.0, 20.0}}});
  return wall.view(lookAlongX({0, 0, 0}, 0.0, 0.0), 0.0, 1);
}

/// Keeps every piece.
PlaneSetOptions keepAll() {
  PlaneSetOptions options;
  options.coarse_kept = 100000;
  options.fine_patches = 100000;
  return options;
}

TEST(PlaneSet, KeepsAFairSampleOfThePieces) {
  const PlaneSet set(squareWall());
  const PlaneSet all(squareWall(), keepAll());
  ASSERT_EQ(set.patches(Level::kFine).size(), 1000U);
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < 1000; ++i) {
    EXPECT_TRUE(set.patches(Level::kFine)[i].rect == all.patches(Level::kFine)[i].rect);
    mean += set.patches(Level::kFine)[i].centroid / 1000.0;
  }
  // Of a wall 2.4 m x 1.8 m: a thousand random places would be off by 2 cm.
  EXPECT_LT(mean.head<2>().norm(), 0.06);
}

TEST(PlaneSet, CutsTilesIntoPiecesThatCoverThem) {
  const PlaneSet set(squareWall(), keepAll());
  EXPECT_EQ(set.patches(Level::kWhole).size(), 300U);
  EXPECT_EQ(set.patches(Level::kCoarse).size(), 1200U);
  EXPECT_EQ(set.patches(Level::kFine).size(), 4800U);
  for (const Level level : {Level::kWhole, Level::kCoarse, Level::kFine}) {
    int pixels = 0;
    double area = 0.0;
    for (const PlanePatch& patch : set.patches(level)) {
      pixels += patch.rect.area();
      area += patch.area;
    }
    EXPECT_EQ(pixels, 640 * 480);
    EXPECT_NEAR(area, 640.0 / 525.0 * 2.0 * 480.0 / 525.0 * 2.0, 1e-4);  // of the wall [m^2]
  }
}

TEST(PlaneSet, PutsCentroidsAndNormalsOnTheSurface) {
  const PlaneSet set(squareWall());
  for (const PlanePatch& patch : set.patches(Level::kFine)) {
    EXPECT_NEAR(patch.centroid.z(), 2.0, 1e-5);  // tiles are floats
    EXPECT_NEAR(patch.d, 2.0, 1e-5);
    EXPECT_LT((patch.normal + Eigen::Vector3d::UnitZ()).norm(), 1e-5);
    const Eigen::Vector2d pixel = projectPoint(set.camera(), patch.centroid);
    EXPECT_NEAR(pixel.x(), patch.rect.x + 0.5 * (patch.rect.width - 1), 1e-3);
    EXPECT_NEAR(pixel.y(), patch.rect.y + 0.5 * (patch.rect.height - 1), 1e-3);
  }
}

TEST(PlaneSet, PredictsTheNoiseOfFittedTiles) {
  const SyntheticPlanes wall({{{2.0, 0.0, 0.0}, {0.0, 20.0, 0.0}, {0.0, 0.0, 20.0}}});
  PlaneSetOptions options = keepAll();
  options.depth_bias = 0.0;  // there is none here
  const PlaneSet set(wall.view(lookAlongX({0, 0, 0}, 0.0, 0.0), options.depth_noise, 1), options);
  double distance = 0.0;
  double tilt = 0.0;
  for (const PlanePatch& patch : set.patches(Level::kFine)) {
    const double error = patch.centroid.z() - 2.0;
    distance += error * error / (patch.distance_sigma * patch.distance_sigma);
    tilt += (patch.normal + Eigen::Vector3d::UnitZ()).squaredNorm() /
            (2.0 * patch.normal_sigma * patch.normal_sigma);
  }
  const double count = static_cast<double>(set.patches(Level::kFine).size());
  // 300 independent tiles: 8 % standard deviation; off-axis rays add a few percent of model error.
  EXPECT_NEAR(distance / count, 1.0, 0.25);
  EXPECT_NEAR(tilt / count, 1.0, 0.25);
}

TEST(PlaneSet, LeavesOutWhatIsFarGrazingOrTiny) {
  PlaneCloud cloud = squareWall();
  PlaneSetOptions options;
  options.max_depth = 1.5;
  EXPECT_TRUE(PlaneSet(cloud, options).empty());
  options = PlaneSetOptions();
  options.min_tile = 33;
  EXPECT_TRUE(PlaneSet(cloud, options).empty());
  cloud.tiles = {{{304, 224, 32, 32}, Eigen::Vector3f(20.0F, 0.0F, 0.5F)}};  // 88.6 degrees
  EXPECT_TRUE(PlaneSet(cloud).empty());
  cloud.tiles[0].inverse_depth = Eigen::Vector3f(0.0F, 0.0F, -0.5F);  // behind the camera
  EXPECT_TRUE(PlaneSet(cloud).empty());
  cloud.tiles[0].inverse_depth = Eigen::Vector3f(0.0F, 0.0F, std::nanf(""));
  EXPECT_TRUE(PlaneSet(cloud).empty());
}

TEST(PlaneSet, KnowsWhichTileAPixelBelongsTo) {
  const PlaneSet set(squareWall());
  for (const PlanePatch& patch : set.patches(Level::kWhole)) {
    const int x = patch.rect.x + patch.rect.width / 2;
    const int y = patch.rect.y + patch.rect.height / 2;
    const std::int32_t seen = set.view().tileAt(x, y);
    ASSERT_GE(seen, 0);
    EXPECT_EQ(&set.patches(Level::kWhole)[static_cast<std::size_t>(seen)], &patch);
  }
}

TEST(PlaneSet, OrdersPatchesIndependentlyOfTheTiles) {
  PlaneCloud cloud = squareWall();
  const PlaneSet first(cloud);
  std::mt19937 random(1);
  std::shuffle(cloud.tiles.begin(), cloud.tiles.end(), random);
  const PlaneSet second(cloud);
  for (std::size_t i = 0; i < first.patches(Level::kFine).size(); ++i) {
    EXPECT_TRUE(first.patches(Level::kFine)[i].rect == second.patches(Level::kFine)[i].rect);
  }
}

TEST(PlaneSet, RefusesTilesOutsideTheImage) {
  PlaneCloud cloud = squareWall();
  cloud.tiles[0].rect.x = 620;
  EXPECT_THROW(PlaneSet{cloud}, std::invalid_argument);
  cloud.tiles[0].rect = {0, 0, 0, 8};
  EXPECT_THROW(PlaneSet{cloud}, std::invalid_argument);
}

}  // namespace
}  // namespace planecloud

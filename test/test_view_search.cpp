// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "planecloud_slam/icap/plane_set.h"
#include "planecloud_slam/icap/view_search.h"
#include "synthetic_planes.h"

namespace planecloud {
namespace {

constexpr double kNoise = 1.6e-3;  // inverse depth of one pixel [1/m]

Eigen::Isometry3d roomPose() { return lookAlongX({-1.8, -0.3, 1.2}, 0.1, 0.1); }

/// Two views of a room, and the source's patches where a motion puts them.
struct Scene {
  PlaneSet target;
  PlaneSet source;
  MovedPatches moved;

  Scene(std::mt19937& random, unsigned seed)
      : target(makeRoom().view(roomPose(), kNoise, 2 * seed)),
        source(makeRoom().view(roomPose(), kNoise, 2 * seed + 1)),
        moved(source.fineColumns(), source.patches(PlaneSet::Level::kFine).size(),
              randomMotion(0.05, 0.03, random)) {}
};

ViewGates gatesOf(float distance) {
  ViewGates gates;
  gates.distance = distance;
  gates.min_cosine = 0.9F;
  gates.squared_normal_length = 0.09F;
  return gates;
}

TEST(ViewSearch, FindsTheSameTilesByVectorsAsOneByOne) {
  std::mt19937 random(1);
  for (unsigned seed = 0; seed < 5; ++seed) {
    const Scene scene(random, seed);
    for (const float distance : {0.02F, 0.1F, 0.5F}) {
      const auto found = bestTiles(scene.target.view(), scene.moved, gatesOf(distance));
      const auto expected = bestTilesScalar(scene.target.view(), scene.moved, gatesOf(distance));
      ASSERT_EQ(found.size(), scene.moved.count);
      int differing = 0;
      int some = 0;
      for (std::size_t i = 0; i < found.size(); ++i) {
        differing += found[i] != expected[i] ? 1 : 0;
        some += found[i] >= 0 ? 1 : 0;
      }
      // Patches on the border of a pixel or of a gate may fall to either side: 1 in 200.
      EXPECT_LE(200 * differing, static_cast<int>(found.size()));
      EXPECT_TRUE(distance < 0.1F || some > 100) << some;
    }
  }
}

TEST(ViewSearch, SeesTheSameByVectorsAsOneByOne) {
  std::mt19937 random(2);
  for (unsigned seed = 0; seed < 5; ++seed) {
    const Scene scene(random, seed);
    const SeenTiles found = lookUpTiles(scene.target.view(), scene.moved);
    const SeenTiles expected = lookUpTilesScalar(scene.target.view(), scene.moved);
    int differing = 0;
    for (std::size_t i = 0; i < scene.moved.count; ++i) {
      if (found.tiles[i] != expected.tiles[i]) ++differing;
      if (found.tiles[i] != expected.tiles[i] || found.tiles[i] < 0) continue;
      EXPECT_FLOAT_EQ(found.depth[i], expected.depth[i]);
      EXPECT_NEAR(found.cosine[i], expected.cosine[i], 1e-6);
      // A grazing plane is met far away: inverse depths tell.
      EXPECT_NEAR(1.0F / found.seen_depth[i], 1.0F / expected.seen_depth[i], 1e-5);
    }
    EXPECT_LE(200 * differing, static_cast<int>(scene.moved.count));
  }
}

TEST(ViewSearch, LooksTilesUpThroughADistortedLens) {
  PlaneCloud cloud = makeRoom().view(roomPose(), 0.0, 1);
  cloud.camera.distortion = {0.05, -0.02, 0.001, 0.001, 0.0};
  const PlaneSet set(cloud);
  const auto& pieces = set.patches(PlaneSet::Level::kFine);
  const SeenTiles seen =
      lookUpTiles(set.view(), {set.fineColumns(), pieces.size(), Eigen::Isometry3d::Identity()});
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const Eigen::Vector2d pixel = projectPoint(cloud.camera, pieces[i].centroid);
    EXPECT_EQ(seen.tiles[i], set.view().tileAt(static_cast<int>(std::lround(pixel.x())),
                                               static_cast<int>(std::lround(pixel.y()))));
  }
}

TEST(ViewSearch, SeesNothingBehindTheCameraNorFromTheBack) {
  std::mt19937 random(3);
  Scene scene(random, 1);
  Eigen::Isometry3d turned = Eigen::Isometry3d::Identity();
  turned.linear() = Eigen::AngleAxisd(3.14159, Eigen::Vector3d::UnitY()).toRotationMatrix();
  const MovedPatches moved(scene.source.fineColumns(), scene.moved.count, turned);
  for (const std::int32_t tile : bestTiles(scene.target.view(), moved, gatesOf(1.0F))) {
    EXPECT_EQ(tile, -1);
  }
  for (const std::int32_t tile : lookUpTiles(scene.target.view(), moved).tiles) {
    EXPECT_EQ(tile, SeenTiles::kNotInView);
  }
}

}  // namespace
}  // namespace planecloud

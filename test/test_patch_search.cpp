// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <random>

#include "planecloud_slam/icap/patch_search.h"

namespace planecloud {
namespace {

Eigen::Vector3d randomVector(std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  return {uniform(random), uniform(random), uniform(random)};
}

PatchColumns randomPatches(std::size_t count, std::mt19937& random) {
  PatchColumns patches;
  for (std::size_t i = 0; i < count; ++i) {
    patches.add(2.0 * randomVector(random), randomVector(random).normalized(), 0.05);
  }
  patches.pad();
  return patches;
}

PatchQuery randomQuery(std::mt19937& random) {
  PatchQuery query;
  query.centroid = (2.0 * randomVector(random)).cast<float>();
  query.normal = randomVector(random).normalized().cast<float>();
  query.radius = 0.1F;
  query.max_squared_distance = 0.5F;
  query.min_cosine = 0.5F;
  query.squared_normal_length = 0.09F;
  return query;
}

TEST(PatchSearch, FindsTheSameByVectorsAsOneByOne) {
  std::mt19937 random(1);
  for (const std::size_t count : {1U, 15U, 16U, 17U, 500U}) {
    const PatchColumns patches = randomPatches(count, random);
    int found = 0;
    for (int i = 0; i < 200; ++i) {
      const PatchQuery query = randomQuery(random);
      const int nearest = nearestPatch(patches, query);
      EXPECT_EQ(nearest, nearestPatchScalar(patches, query));
      EXPECT_LT(nearest, static_cast<int>(count)) << "never the padding";
      found += nearest >= 0 ? 1 : 0;
    }
    EXPECT_TRUE(count < 100 || found > 100);
  }
}

TEST(PatchSearch, FindsNothingAmongNothingAndBeyondItsGates) {
  std::mt19937 random(2);
  EXPECT_EQ(nearestPatch(PatchColumns(), randomQuery(random)), -1);
  PatchColumns patches;
  patches.add({0.0, 0.0, 2.0}, -Eigen::Vector3d::UnitZ(), 0.1);
  patches.pad();
  PatchQuery query;
  query.centroid = {0.0F, 0.0F, 2.2F};
  query.normal = {0.0F, 0.0F, -1.0F};
  query.max_squared_distance = 0.05F;
  EXPECT_EQ(nearestPatch(patches, query), 0);
  query.max_squared_distance = 0.03F;  // 0.2 m squared is 0.04
  EXPECT_EQ(nearestPatch(patches, query), -1);
  query.max_squared_distance = 0.05F;
  query.normal = {0.0F, 0.0F, 1.0F};  // the back of the surface
  EXPECT_EQ(nearestPatch(patches, query), -1);
}

TEST(PatchSearch, ForgivesWhatLiesWithinTheExtents) {
  PatchColumns patches;
  patches.add({0.0, 0.0, 2.0}, -Eigen::Vector3d::UnitZ(), 0.5);   // large, its centre is far
  patches.add({0.4, 0.0, 2.1}, -Eigen::Vector3d::UnitZ(), 0.01);  // nearer, on another plane
  patches.pad();
  PatchQuery query;
  query.centroid = {0.4F, 0.0F, 2.0F};
  query.normal = {0.0F, 0.0F, -1.0F};
  query.max_squared_distance = 1.0F;
  EXPECT_EQ(nearestPatch(patches, query), 0);
}

}  // namespace
}  // namespace planecloud

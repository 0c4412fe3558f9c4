// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "planar_scene.h"
#include "planecloud_slam/plane_fit/coding_order.h"
#include "planecloud_slam/plane_fit/quadtree_fitter.h"

namespace planecloud {
namespace {

std::shared_ptr<const Camera> makeCamera(const CameraIntrinsics& intrinsics) {
  return std::make_shared<const Camera>(intrinsics);
}

QuadtreeFitterOptions fixedOptions(double tolerance) {
  QuadtreeFitterOptions options;
  options.acceptance = AcceptanceRule::kFixed;
  options.tolerance = tolerance;
  options.lambda = 0.0;  // the paper's rule
  return options;
}

Image<float> noisyCorridor(const Camera& camera, std::uint32_t seed) {
  Image<float> depth = renderCorridor(camera);
  addSensorNoise(depth, 0.5, seed);
  return depth;
}

double tiledArea(const PlaneCloud& cloud) {
  double area = 0.0;
  for (const PlanarTile& tile : cloud.tiles) area += tile.rect.area();
  return area;
}

TEST(QuadtreeFitter, RecoversOnePlaneFromItsInitialTiles) {
  for (const CameraIntrinsics& intrinsics : {testCamera(), distortedTestCamera()}) {
    const auto camera = makeCamera(intrinsics);
    const Eigen::Vector3f plane(0.1F, -0.3F, 0.7F);
    QuadtreeFitter fitter(camera, {});
    const PlaneCloud cloud = fitter.fit(renderPlane(*camera, plane).view());
    ASSERT_EQ(cloud.tiles.size(), 80U);
    for (const PlanarTile& tile : cloud.tiles) {
      // Depth is float: 1e-7 of q over a tile of 0.12 in tangents.
      EXPECT_LT((tile.inverse_depth - plane).norm(), 2e-5);
    }
    EXPECT_DOUBLE_EQ(cloud.statistics.coverage, 1.0);
    EXPECT_LT(cloud.statistics.depth_error, 1e-5);
    EXPECT_LT(cloud.statistics.point_plane_error, 1e-5);
  }
}

TEST(QuadtreeFitter, ReadsMillimetresAsMetres) {
  const auto camera = makeCamera(testCamera());
  const Image<std::uint16_t> millimetres = toMillimetres(noisyCorridor(*camera, 1));
  Image<float> metres(millimetres.width(), millimetres.height());
  for (int y = 0; y < metres.height(); ++y) {
    for (int x = 0; x < metres.width(); ++x) {
      metres(x, y) = static_cast<float>(millimetres(x, y)) / 1000.0F;
    }
  }
  QuadtreeFitter fitter(camera, {});
  const PlaneCloud a = fitter.fit(millimetres.view());
  const PlaneCloud b = fitter.fit(metres.view());
  ASSERT_GT(a.tiles.size(), 100U);
  // The same up to rounding of 1 / z: single tiles at the tolerance may differ.
  EXPECT_NEAR(static_cast<double>(a.tiles.size()), static_cast<double>(b.tiles.size()),
              0.01 * static_cast<double>(a.tiles.size()));
  EXPECT_NEAR(a.statistics.coverage, b.statistics.coverage, 1e-3);
  EXPECT_NEAR(a.statistics.depth_error, b.statistics.depth_error, 1e-4);
}

TEST(QuadtreeFitter, TilesAreNodesInCodingOrderForEverySizeAndLayout) {
  const int sizes[][2] = {{848, 480}, {320, 240}, {641, 479}};
  const int layouts[][3] = {{64, 64, 4}, {80, 60, 2}, {24, 24, 2}, {40, 40, 3}, {8, 16, 8}};
  for (const auto& size : sizes) {
    const auto camera = makeCamera(testCamera(size[0], size[1]));
    const Image<float> depth = noisyCorridor(*camera, 2);
    for (const auto& layout : layouts) {
      QuadtreeFitterOptions options;
      options.initial_tile_width = layout[0];
      options.initial_tile_height = layout[1];
      options.min_tile = layout[2];
      const PlaneCloud cloud = QuadtreeFitter(camera, options).fit(depth.view());
      EXPECT_GT(cloud.statistics.coverage, 0.8) << size[0] << " " << layout[0];
      const QuadtreeGrid grid(cloud.layout, size[0], size[1]);
      const std::vector<TileNode> ordered = inCodingOrder(grid, cloud.tiles);
      std::size_t displaced = 0;
      for (std::size_t i = 0; i < ordered.size(); ++i) {
        displaced += ordered[i].tile.rect == cloud.tiles[i].rect ? 0U : 1U;
      }
      // Only in the clipped corner several nodes have the same pixels.
      if (size[0] % layout[0] == 0 && size[1] % layout[1] == 0) {
        EXPECT_EQ(displaced, 0U);
      }
    }
  }
}

TEST(QuadtreeFitter, FindsNothingWhereThereIsNoDepth) {
  const auto camera = makeCamera(testCamera());
  QuadtreeFitter fitter(camera, {});
  const Image<float> nan(640, 480, std::numeric_limits<float>::quiet_NaN());
  EXPECT_TRUE(fitter.fit(nan.view()).tiles.empty());
  EXPECT_EQ(fitter.fit(nan.view()).statistics.coverage, 0.0);
  const Image<std::uint16_t> zero(640, 480, 0);
  EXPECT_TRUE(fitter.fit(zero.view()).tiles.empty());
}

TEST(QuadtreeFitter, RefusesAnImageOfAnotherSize) {
  QuadtreeFitter fitter(makeCamera(testCamera()), {});
  const Image<float> small(320, 240, 1.0F);
  EXPECT_THROW((void)fitter.fit(small.view()), std::invalid_argument);
}

TEST(QuadtreeFitter, SinglePixelHolesForceNoSubdivisionUnlessThePaperIsTakenLiterally) {
  const auto camera = makeCamera(testCamera());
  Image<float> depth = renderPlane(*camera, {0.0F, 0.1F, 0.5F});
  for (int y = 0; y < 480; y += 64) {
    for (int x = 0; x < 640; x += 64) depth(x, y) = std::numeric_limits<float>::quiet_NaN();
  }
  QuadtreeFitterOptions options;
  options.lambda = 0.0;
  EXPECT_EQ(QuadtreeFitter(camera, options).fit(depth.view()).tiles.size(), 80U);
  options.corner_check = CornerCheck::kExact;
  EXPECT_GT(QuadtreeFitter(camera, options).fit(depth.view()).tiles.size(), 400U);
  options.corner_check = CornerCheck::kNone;
  EXPECT_EQ(QuadtreeFitter(camera, options).fit(depth.view()).tiles.size(), 80U);
}

/// A wall 1 m to the right of x = 320, one 3 m away to the left: a tile over the edge is nearly
/// fitted by a plane that contains the viewing rays.
Image<float> depthJump(const Camera& camera, int edge) {
  Image<float> depth(camera.width(), camera.height());
  for (int y = 0; y < camera.height(); ++y) {
    for (int x = 0; x < camera.width(); ++x) depth(x, y) = x < edge ? 1.0F : 1.4F;
  }
  return depth;
}

TEST(QuadtreeFitter, AlongTheRayTestRefusesCurtainPlanes) {
  const auto camera = makeCamera(testCamera());
  const Image<float> depth = depthJump(*camera, 320 + 2);
  QuadtreeFitterOptions options = fixedOptions(0.0131);
  options.along_ray_test = false;
  options.planarity_factor = 0.0;
  const PlaneCloud with_curtains = QuadtreeFitter(camera, options).fit(depth.view());
  options.along_ray_test = true;
  const PlaneCloud without = QuadtreeFitter(camera, options).fit(depth.view());
  EXPECT_GT(with_curtains.statistics.depth_error, 3.0 * without.statistics.depth_error + 1e-4);
  for (const PlanarTile& tile : without.tiles) {
    if (tile.rect.x <= 322 && tile.rect.x + tile.rect.width > 322) {
      ADD_FAILURE() << "a tile bridges the jump at " << tile.rect.x << ", " << tile.rect.y;
    }
  }
}

TEST(QuadtreeFitter, PlanarityCheckSubdividesACornerThatSticksOut) {
  const auto camera = makeCamera(testCamera());
  Image<float> depth = renderPlane(*camera, {0.0F, 0.0F, 1.0F});
  for (int y = 60; y < 64; ++y) {
    for (int x = 60; x < 64; ++x) depth(x, y) = 1.2F;
  }
  QuadtreeFitterOptions options = fixedOptions(0.0131);
  EXPECT_GT(QuadtreeFitter(camera, options).fit(depth.view()).tiles.size(), 80U);
  options.planarity_factor = 0.0;
  EXPECT_EQ(QuadtreeFitter(camera, options).fit(depth.view()).tiles.size(), 80U);
}

/// A staircase in q of +-`amplitude`, checkered pixel by pixel, at inverse depth `q`.
Image<float> checkered(const Camera& camera, float q, float amplitude) {
  Image<float> depth(camera.width(), camera.height());
  for (int y = 0; y < camera.height(); ++y) {
    for (int x = 0; x < camera.width(); ++x) {
      depth(x, y) = 1.0F / (q + ((x + y) % 2 == 0 ? amplitude : -amplitude));
    }
  }
  return depth;
}

/// Does a checkered wall at depth z pass, when its mean depth error is `error`?
bool accepts(AcceptanceRule rule, double tolerance, float z, float error) {
  const auto camera = makeCamera(testCamera());
  QuadtreeFitterOptions options = fixedOptions(tolerance);
  options.acceptance = rule;
  options.planarity_factor = 0.0;
  const Image<float> depth = checkered(*camera, 1.0F / z, error / (z * z));
  return QuadtreeFitter(camera, options).fit(depth.view()).tiles.size() == 80U;
}

TEST(QuadtreeFitter, AcceptanceRulesGrowWithTheirPowerOfDepth) {
  // Mean error in units of 1 cm, at 1 m and at 3 m; 5 % to either side of the limit.
  for (const float side : {0.95F, 1.05F}) {
    const bool inside = side < 1.0F;
    EXPECT_EQ(accepts(AcceptanceRule::kFixed, 0.01, 1.0F, 0.01F * side), inside);
    EXPECT_EQ(accepts(AcceptanceRule::kFixed, 0.01, 3.0F, 0.01F * side), inside);
    EXPECT_EQ(accepts(AcceptanceRule::kLinearInDepth, 0.01, 1.0F, 0.01F * side), inside);
    EXPECT_EQ(accepts(AcceptanceRule::kLinearInDepth, 0.01, 3.0F, 0.03F * side), inside);
    EXPECT_EQ(accepts(AcceptanceRule::kNoiseScaled, 0.01, 1.0F, 0.01F * side), inside);
    EXPECT_EQ(accepts(AcceptanceRule::kNoiseScaled, 0.01, 3.0F, 0.09F * side), inside);
  }
}

TEST(QuadtreeFitter, ByteBudgetKeepsTheCoarsestTiles) {
  const auto camera = makeCamera(testCamera());
  const Image<float> depth = noisyCorridor(*camera, 4);
  QuadtreeFitter fitter(camera, {});
  const PlaneCloud whole = fitter.fit(depth.view());
  EXPECT_FALSE(whole.statistics.stopped_by_bytes);
  double coverage = -1.0;
  for (const std::size_t bytes : {0, 31, 320, 1000, 3200, 10000, 1000000}) {
    FitBudget budget;
    budget.bytes = bytes;
    const PlaneCloud part = fitter.fit(depth.view(), budget);
    ASSERT_LE(part.tiles.size() * 32, bytes);
    EXPECT_EQ(part.statistics.stopped_by_bytes, part.tiles.size() < whole.tiles.size());
    for (std::size_t i = 0; i < part.tiles.size(); ++i) {
      ASSERT_EQ(part.tiles[i].rect, whole.tiles[i].rect);
    }
    EXPECT_GE(part.statistics.coverage, coverage);
    coverage = part.statistics.coverage;
  }
  EXPECT_EQ(coverage, whole.statistics.coverage);
}

/// A clock that moves one second at each look.
struct TickingClock {
  std::shared_ptr<int> looks = std::make_shared<int>(0);
  FitBudget::Clock::time_point operator()() const {
    return FitBudget::Clock::time_point(std::chrono::seconds((*looks)++));
  }
};

TEST(QuadtreeFitter, DeadlineLeavesACoarserCloud) {
  const auto camera = makeCamera(testCamera());
  const Image<float> depth = noisyCorridor(*camera, 5);
  QuadtreeFitterOptions options;
  options.lambda = 0.0;
  QuadtreeFitter fitter(camera, options);
  const PlaneCloud whole = fitter.fit(depth.view());
  double coverage = -1.0;
  bool stopped_half_way = false;
  for (const double seconds : {1.0, 30.0, 60.0, 76.0, 80.0, 90.0, 120.0, 1e6}) {
    const PlaneCloud part = fitter.fit(depth.view(), FitBudget::fromNow(seconds, TickingClock()));
    for (std::size_t i = 0; i < part.tiles.size(); ++i) {
      ASSERT_EQ(part.tiles[i].rect, whole.tiles[i].rect);
    }
    EXPECT_EQ(part.statistics.stopped_by_time, part.tiles.size() < whole.tiles.size());
    EXPECT_GE(part.statistics.coverage, coverage);
    stopped_half_way = stopped_half_way || (part.statistics.stopped_by_time && !part.tiles.empty());
    coverage = part.statistics.coverage;
  }
  EXPECT_TRUE(stopped_half_way);
  EXPECT_EQ(coverage, whole.statistics.coverage);
}

TEST(QuadtreeFitter, DeadlineNeedsAClock) {
  QuadtreeFitter fitter(makeCamera(testCamera()), {});
  FitBudget budget;
  budget.deadline = FitBudget::Clock::time_point();
  EXPECT_THROW((void)fitter.fit(Image<float>(640, 480, 1.0F).view(), budget),
               std::invalid_argument);
}

TEST(QuadtreeFitter, CoverageCountsTiledValidPixels) {
  const auto camera = makeCamera(testCamera());
  const Image<float> depth = renderCorridor(*camera);
  const PlaneCloud cloud = QuadtreeFitter(camera, {}).fit(depth.view());
  EXPECT_DOUBLE_EQ(cloud.statistics.coverage, tiledArea(cloud) / (640.0 * 480.0));
}

TEST(QuadtreeFitter, GivesTheSameTwice) {
  const auto camera = makeCamera(testCamera());
  const Image<float> depth = noisyCorridor(*camera, 6);
  QuadtreeFitter fitter(camera, {});
  const PlaneCloud a = fitter.fit(depth.view());
  (void)fitter.fit(renderCorridor(*camera).view());
  const PlaneCloud b = fitter.fit(depth.view());
  ASSERT_EQ(a.tiles.size(), b.tiles.size());
  for (std::size_t i = 0; i < a.tiles.size(); ++i) {
    ASSERT_EQ(a.tiles[i].rect, b.tiles[i].rect);
    ASSERT_EQ(a.tiles[i].inverse_depth, b.tiles[i].inverse_depth);
  }
}

TEST(QuadtreeFitterOptions, NameKeyValueAndRange) {
  QuadtreeFitterOptions options;
  options.min_tile = 1;
  try {
    options.check();
    FAIL() << "min_tile = 1 was accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "plane_fit/min_tile = 1: must be in [2, 64]");
  }
  options = {};
  options.tolerance = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(options.check(), std::invalid_argument);
  AcceptanceRule rule = AcceptanceRule::kFixed;
  EXPECT_THROW(fromString("exact", rule), std::invalid_argument);
  fromString("linear_in_depth", rule);
  EXPECT_EQ(rule, AcceptanceRule::kLinearInDepth);
  CornerCheck check = CornerCheck::kNone;
  fromString("exact", check);
  EXPECT_EQ(toString(check), "exact");
}

}  // namespace
}  // namespace planecloud

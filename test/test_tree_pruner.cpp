// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "planar_scene.h"
#include "planecloud_slam/plane_fit/coding_order.h"
#include "planecloud_slam/plane_fit/plane_cloud_codec.h"
#include "planecloud_slam/plane_fit/quadtree_fitter.h"
#include "planecloud_slam/plane_fit/reconstruction.h"
#include "planecloud_slam/plane_fit/tree_pruner.h"
#include "split_all.h"

namespace planecloud {
namespace {

struct NoisyCorridor {
  std::shared_ptr<const Camera> camera = std::make_shared<const Camera>(testCamera());
  Image<float> truth = renderCorridor(*camera);
  Image<float> depth = truth;
  explicit NoisyCorridor(std::uint32_t seed) { addSensorNoise(depth, 0.5, seed); }
};

QuadtreeFitterOptions withLambda(double lambda) {
  QuadtreeFitterOptions options;
  options.lambda = lambda;
  return options;
}

/// Mean difference of depths [m] over the pixels where both have one.
double meanDifference(const Image<float>& a, const Image<float>& b) {
  double sum = 0.0;
  double count = 0.0;
  for (int y = 0; y < a.height(); ++y) {
    for (int x = 0; x < a.width(); ++x) {
      if (std::isnan(a(x, y)) || std::isnan(b(x, y))) continue;
      sum += std::abs(a(x, y) - b(x, y));
      count += 1.0;
    }
  }
  return sum / count;
}

TEST(TreePruner, MakesSmallerCloudsThatAreTruerThanTheSensor) {
  const NoisyCorridor scene(1);
  const PlaneCloud whole = QuadtreeFitter(scene.camera, withLambda(0.0)).fit(scene.depth.view());
  const PlaneCloud pruned = QuadtreeFitter(scene.camera, {}).fit(scene.depth.view());
  EXPECT_LT(encode(pruned, {}).bytes.size(), encode(whole, {}).bytes.size());
  EXPECT_GE(pruned.statistics.coverage, whole.statistics.coverage);
  EXPECT_LT(meanDifference(reconstructDepth(pruned, *scene.camera), scene.truth),
            0.5 * meanDifference(scene.depth, scene.truth));
}

TEST(TileFitter, WeighsNodesByTheRootMeanSquareOfTheirResiduals) {
  const NoisyCorridor scene(4);
  for (const AcceptanceRule rule :
       {AcceptanceRule::kFixed, AcceptanceRule::kLinearInDepth, AcceptanceRule::kNoiseScaled}) {
    QuadtreeFitterOptions options;
    options.acceptance = rule;
    MomentPyramid pyramid(scene.camera, {64, 64, 4}, vectorTileKernels(),
                          TileFitter::distortionRule(options));
    const TileFitter fitter(pyramid, options);
    ASSERT_TRUE(pyramid.read(scene.depth.view(), nullptr));
    splitAll(pyramid);
    int known = 0;
    for (int level = 0; level < pyramid.grid().levels(); ++level) {
      for (int row = 0; row < pyramid.grid().rows(level); ++row) {
        for (int column = 0; column < pyramid.grid().columns(level); ++column) {
          const QuadtreeNode node{level, column, row};
          const float distortion = fitter.distortion(node);
          if (distortion < 0.0F) continue;
          const double depth = 1.0 / pyramid.meanInverseDepth(node);
          const double relative = 0.798 * std::abs(pyramid.regress(node).rms) * depth;
          const double expected =
              pyramid.count(node) * relative * depth /
              (options.tolerance * (rule == AcceptanceRule::kNoiseScaled     ? depth * depth
                                    : rule == AcceptanceRule::kLinearInDepth ? depth
                                                                             : 1.0));
          // Cells are weighed in pixels, from sums whose squares lose some 1e-7.
          ASSERT_NEAR(distortion, expected, 1e-2 * expected + 1e-3 * pyramid.count(node));
          ++known;
        }
      }
    }
    EXPECT_GT(known, 15000);
  }
}

TEST(TreePruner, SpendsFewerBytesTheMoreABitCosts) {
  const NoisyCorridor scene(2);
  std::size_t bytes = static_cast<std::size_t>(-1);
  double error = 0.0;
  for (const double lambda : {0.1, 1.0, 3.0, 10.0, 30.0}) {
    const PlaneCloud cloud =
        QuadtreeFitter(scene.camera, withLambda(lambda)).fit(scene.depth.view());
    EXPECT_LT(encode(cloud, {}).bytes.size(), bytes) << lambda;
    const double residual = meanDifference(reconstructDepth(cloud, *scene.camera), scene.depth);
    EXPECT_GT(residual, error) << lambda;
    bytes = encode(cloud, {}).bytes.size();
    error = residual;
  }
}

TEST(TreePruner, EstimatesTheErrorThatALookAtThePixelsFinds) {
  const NoisyCorridor scene(3);
  MomentPyramid pyramid(scene.camera, {64, 64, 4}, vectorTileKernels(),
                        TileFitter::distortionRule({}));
  ASSERT_TRUE(pyramid.read(scene.depth.view(), nullptr));
  const TileFitter fitter(pyramid, {});
  double estimated = 0.0;
  double sampled = 0.0;
  double measured = 0.0;
  for (int row = 0; row < pyramid.grid().rows(2); ++row) {
    for (int column = 0; column < pyramid.grid().columns(2); ++column) {
      const QuadtreeNode node{2, column, row};
      if (!fitter.fit(node)) continue;  // only where there is nothing but noise
      const TileFit estimate = fitter.estimate(node);
      estimated += estimate.depth_sum;
      sampled += fitter.sample(node, estimate.plane).depth_sum;
      measured += fitter.fit(node)->depth_sum;
    }
  }
  ASSERT_GT(measured, 0.0);
  EXPECT_NEAR(sampled / measured, 1.0, 0.02);
  EXPECT_NEAR(estimated / measured, 1.0, 0.05);  // rounding to steps is no normal distribution
}

TEST(TreePruner, RefusesTilesTwoTolerancesOff) {
  const NoisyCorridor scene(4);
  const QuadtreeFitterOptions options;
  QuadtreeFitter fitter(scene.camera, options);
  const PlaneCloud cloud = fitter.fit(scene.depth.view());
  for (const PlanarTile& tile : cloud.tiles) {
    double sum = 0.0;
    double count = 0.0;
    for (int y = tile.rect.y; y < tile.rect.y + tile.rect.height; ++y) {
      for (int x = tile.rect.x; x < tile.rect.x + tile.rect.width; ++x) {
        if (std::isnan(scene.depth(x, y))) continue;
        const Eigen::Vector3f ray(scene.camera->tangentsX()(x, y), scene.camera->tangentsY()(x, y),
                                  1.0F);
        sum += std::abs(1.0F / scene.depth(x, y) - tile.inverse_depth.dot(ray));
        count += 1.0;
      }
    }
    // Where residuals are no noise (an edge in the tile), their mean exceeds the estimate.
    EXPECT_LT(sum / count, 1.3 * 2.0 * options.tolerance);
  }
}

/// A clock that moves one second at each look.
struct TickingClock {
  std::shared_ptr<int> looks = std::make_shared<int>(0);
  FitBudget::Clock::time_point operator()() const {
    return FitBudget::Clock::time_point(std::chrono::seconds((*looks)++));
  }
};

TEST(TreePruner, StopsWithinAFewNodesAndLeavesACoarserValidCloud) {
  const NoisyCorridor scene(5);
  QuadtreeFitter fitter(scene.camera, {});
  const PlaneCloud whole = fitter.fit(scene.depth.view());
  const QuadtreeGrid grid(whole.layout, 640, 480);
  double coverage = -1.0;
  bool stopped_half_way = false;
  // 122 looks while the image is read and a reserve, then one every 32 nodes and a reserve.
  for (int seconds = 110; seconds < 1100; seconds += seconds < 300 ? 3 : 100) {
    const TickingClock clock;
    const PlaneCloud part = fitter.fit(scene.depth.view(), FitBudget::fromNow(seconds, clock));
    EXPECT_LE(*clock.looks, std::max(122, seconds + 4));
    EXPECT_EQ(inCodingOrder(grid, part.tiles).size(), part.tiles.size());
    EXPECT_GE(part.statistics.coverage, coverage);
    coverage = part.statistics.coverage;
    stopped_half_way = stopped_half_way || (part.statistics.stopped_by_time && !part.tiles.empty());
  }
  EXPECT_TRUE(stopped_half_way);
  EXPECT_EQ(coverage, whole.statistics.coverage);
}

}  // namespace
}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "planar_scene.h"
#include "planecloud_slam/plane_fit/plane_cloud_codec.h"
#include "planecloud_slam/plane_fit/quadtree_fitter.h"
#include "planecloud_slam/plane_fit/quadtree_grid.h"
#include "planecloud_slam/plane_fit/validity_mask.h"

namespace planecloud {
namespace {

const std::vector<QuadtreeLayout> kLayouts = {{64, 64, 4}, {80, 60, 2}, {24, 24, 2}, {40, 40, 3}};

CodecOptions raw() {
  CodecOptions options;
  options.encoding = PlaneCloudEncoding::kRaw;
  return options;
}

CodecOptions withMask() {
  CodecOptions options;
  options.mask = true;
  return options;
}

double areaOf(const PlaneCloud& cloud) {
  double area = 0.0;
  for (const PlanarTile& tile : cloud.tiles) area += tile.rect.area();
  return area;
}

/// Random nodes of the quadtrees with random planes in front of the camera, steep ones included.
PlaneCloud randomCloud(const CameraIntrinsics& camera, const QuadtreeLayout& layout,
                       std::uint32_t seed) {
  PlaneCloud cloud;
  cloud.camera = camera;
  cloud.layout = layout;
  const QuadtreeGrid grid(layout, camera.width, camera.height);
  std::mt19937 random(seed);
  const auto uniform = [&random] { return static_cast<float>(random() % 10001) / 10000.0F; };
  std::vector<QuadtreeNode> queue;
  for (int row = 0; row < grid.rows(0); ++row) {
    for (int column = 0; column < grid.columns(0); ++column) queue.push_back({0, column, row});
  }
  for (std::size_t i = 0; i < queue.size(); ++i) {
    const QuadtreeNode node = queue[i];
    const TileRect rect = grid.rect(node);
    if (rect.area() == 0) continue;
    const float choice = uniform();
    if (choice < 0.3F) {
      const float q = 0.1F + 3.0F * uniform() * uniform();
      const float half_u = 0.5F * static_cast<float>(rect.width) / static_cast<float>(camera.fx);
      const float half_v = 0.5F * static_cast<float>(rect.height) / static_cast<float>(camera.fy);
      const auto center =
          tangentsAt(camera, rect.x + 0.5 * (rect.width - 1), rect.y + 0.5 * (rect.height - 1));
      PlanarTile tile;
      tile.rect = rect;
      tile.inverse_depth.x() = q * 0.45F * (2.0F * uniform() - 1.0F) / half_u;
      tile.inverse_depth.y() = q * 0.45F * (2.0F * uniform() - 1.0F) / half_v;
      tile.inverse_depth.z() = q - tile.inverse_depth.x() * static_cast<float>(center->x()) -
                               tile.inverse_depth.y() * static_cast<float>(center->y());
      cloud.tiles.push_back(tile);
    } else if (choice < 0.8F && node.level + 1 < grid.levels()) {
      for (int child = 0; child < 4; ++child) {
        queue.push_back({node.level + 1, 2 * node.column + child % 2, 2 * node.row + child / 2});
      }
    }
  }
  return cloud;
}

PlaneCloud corridorCloud(std::uint32_t seed) {
  const auto camera = std::make_shared<const Camera>(testCamera());
  Image<float> depth = renderCorridor(*camera);
  addSensorNoise(depth, 0.5, seed);
  PlaneCloud cloud = QuadtreeFitter(camera, {}).fit(depth.view());
  cloud.mask = validityMask(depth.view());
  return cloud;
}

void expectSameTiles(const PlaneCloud& a, const PlaneCloud& b) {
  ASSERT_EQ(a.tiles.size(), b.tiles.size());
  for (std::size_t i = 0; i < a.tiles.size(); ++i) {
    ASSERT_EQ(a.tiles[i].rect, b.tiles[i].rect);
    ASSERT_EQ(a.tiles[i].inverse_depth, b.tiles[i].inverse_depth);
  }
}

TEST(PlaneCloudCodec, IsExactOnQuantisedClouds) {
  std::uint32_t seed = 0;
  for (const QuadtreeLayout& layout : kLayouts) {
    for (const CameraIntrinsics& camera :
         {testCamera(), testCamera(641, 479), testCamera(848, 480), distortedTestCamera()}) {
      for (const double step : {1e-4, 1e-3, 0.05}) {
        CodecOptions options;
        options.quantisation_step = step;
        const PlaneCloud cloud = randomCloud(camera, layout, ++seed);
        const EncodedPlaneCloud encoded = encode(cloud, options);
        const PlaneCloud decoded = decode(encoded);
        ASSERT_EQ(decoded.tiles.size(), cloud.tiles.size());
        ASSERT_EQ(encoded.plane_count, cloud.tiles.size());
        EXPECT_EQ(decoded.layout, cloud.layout);
        EXPECT_EQ(encode(decoded, options).bytes, encoded.bytes);
        expectSameTiles(decode(encode(decoded, options)), decoded);
        expectSameTiles(quantise(cloud, options), decoded);
      }
    }
  }
}

TEST(PlaneCloudCodec, MovesPlanesByLessThanTheStep) {
  const PlaneCloud cloud = randomCloud(testCamera(), {64, 64, 4}, 77);
  CodecOptions options;
  const PlaneCloud decoded = quantise(cloud, options);
  ASSERT_EQ(decoded.tiles.size(), cloud.tiles.size());
  for (std::size_t i = 0; i < cloud.tiles.size(); ++i) {
    const PlanarTile& a = cloud.tiles[i];
    const PlanarTile& b = decoded.tiles[i];
    ASSERT_EQ(a.rect, b.rect);
    const double u = (a.rect.x + 0.5 * (a.rect.width - 1) - cloud.camera.cx) / cloud.camera.fx;
    const double v = (a.rect.y + 0.5 * (a.rect.height - 1) - cloud.camera.cy) / cloud.camera.fy;
    const Eigen::Vector3d change = (a.inverse_depth - b.inverse_depth).cast<double>();
    // Half a step at the centre, float rounding of steep planes on top.
    EXPECT_LT(std::abs(change.dot(Eigen::Vector3d(u, v, 1.0))),
              0.5 * options.quantisation_step + 3e-5);
  }
}

TEST(PlaneCloudCodec, TakesABudgetOfBitsAPlaneOnAScene) {
  const PlaneCloud cloud = corridorCloud(1);
  ASSERT_GT(cloud.tiles.size(), 150U);
  const EncodedPlaneCloud encoded = encode(cloud, {});
  EXPECT_LT(8.0 * static_cast<double>(encoded.bytes.size()),
            26.0 * static_cast<double>(cloud.tiles.size()));
  EXPECT_EQ(encode(cloud, raw()).bytes.size(), 8 + 32 * cloud.tiles.size());
}

TEST(PlaneCloudCodec, RawReturnsPlanesToFloatPrecision) {
  const PlaneCloud cloud = randomCloud(testCamera(), {64, 64, 4}, 5);
  const PlaneCloud decoded = decode(encode(cloud, raw()));
  ASSERT_EQ(decoded.tiles.size(), cloud.tiles.size());
  for (std::size_t i = 0; i < cloud.tiles.size(); ++i) {
    ASSERT_EQ(decoded.tiles[i].rect, cloud.tiles[i].rect);
    EXPECT_LT((decoded.tiles[i].inverse_depth - cloud.tiles[i].inverse_depth).norm(),
              1e-6 * cloud.tiles[i].inverse_depth.norm());
  }
}

TEST(PlaneCloudCodec, CodesTheEmptyCloud) {
  PlaneCloud empty;
  empty.camera = testCamera();
  for (const CodecOptions& options : {CodecOptions{}, raw()}) {
    const EncodedPlaneCloud encoded = encode(empty, options);
    EXPECT_LE(encoded.bytes.size(), 9U);
    EXPECT_TRUE(decode(encoded).tiles.empty());
  }
}

TEST(PlaneCloudCodec, NeverExceedsTheByteBudgetAndNeverCoversLessForMore) {
  const PlaneCloud cloud = corridorCloud(2);
  for (CodecOptions options : {CodecOptions{}, raw(), withMask()}) {
    const std::size_t whole_size = encode(cloud, options).bytes.size();
    double area = 0.0;
    double coverage = 0.0;
    for (int budget = 64; budget < 50000; budget = budget * 5 / 4) {
      options.byte_budget = budget;
      const EncodedPlaneCloud encoded = encode(cloud, options);
      ASSERT_LE(encoded.bytes.size(), static_cast<std::size_t>(budget));
      EXPECT_EQ(encoded.statistics.stopped_by_bytes, static_cast<std::size_t>(budget) < whole_size);
      const double decoded_area = areaOf(decode(encoded));
      EXPECT_GE(decoded_area, area) << budget;
      EXPECT_GE(encoded.statistics.coverage, coverage) << budget;
      EXPECT_NEAR(encoded.statistics.coverage,
                  cloud.statistics.coverage * decoded_area / areaOf(cloud), 1e-9);
      area = decoded_area;
      coverage = encoded.statistics.coverage;
    }
    EXPECT_EQ(area, areaOf(cloud));
  }
}

TEST(PlaneCloudCodec, MergesTilesBeforeItLeavesThemOut) {
  // One wall, cut into the smallest tiles: all of it fits in the bytes of its initial tiles.
  PlaneCloud cloud;
  cloud.camera = testCamera();
  const QuadtreeGrid grid(cloud.layout, cloud.camera.width, cloud.camera.height);
  for (int row = 0; row < grid.cellRows(); ++row) {
    for (int column = 0; column < grid.cellColumns(); ++column) {
      PlanarTile tile;
      tile.rect = grid.rect({grid.levels() - 1, column, row});
      tile.inverse_depth << 0.1F, -0.2F, 0.8F;
      if (tile.rect.area() > 0) cloud.tiles.push_back(tile);
    }
  }
  CodecOptions options;
  options.byte_budget = 500;
  const PlaneCloud decoded = decode(encode(cloud, options));
  EXPECT_EQ(areaOf(decoded), areaOf(cloud));
  EXPECT_LT(decoded.tiles.size(), 400U);
  options.encoding = PlaneCloudEncoding::kRaw;
  options.byte_budget = 8 + 32 * 80;
  EXPECT_EQ(decode(encode(cloud, options)).tiles.size(), 80U);
}

TEST(PlaneCloudCodec, ReturnsTheMaskExactly) {
  const PlaneCloud cloud = corridorCloud(4);
  const PlaneCloud decoded = decode(encode(cloud, withMask()));
  ASSERT_EQ(decoded.mask.width(), 640);
  Image<std::uint8_t> expected(640, 480, 0);
  for (const PlanarTile& tile : cloud.tiles) {
    for (int y = tile.rect.y; y < tile.rect.y + tile.rect.height; ++y) {
      std::copy_n(cloud.mask.row(y) + tile.rect.x, tile.rect.width, expected.row(y) + tile.rect.x);
    }
  }
  EXPECT_TRUE(std::equal(expected.begin(), expected.end(), decoded.mask.begin()));
  EXPECT_EQ(encode(decoded, withMask()).bytes, encode(cloud, withMask()).bytes);
  EXPECT_TRUE(decode(encode(cloud, {})).mask.empty());
  PlaneCloud without = cloud;
  without.mask = {};
  EXPECT_THROW((void)encode(without, withMask()), std::invalid_argument);
}

TEST(PlaneCloudCodec, RefusesToEncodeWhatIsNotInFrontOfTheCamera) {
  PlaneCloud cloud;
  cloud.camera = testCamera();
  PlanarTile tile;
  tile.rect = {0, 0, 64, 64};
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const Eigen::Vector3f& plane :
       {Eigen::Vector3f(0.0F, 0.0F, -1.0F), Eigen::Vector3f(0.0F, 0.0F, 0.0F),
        Eigen::Vector3f(20.0F, 0.0F, 10.9F), Eigen::Vector3f(nan, 0.0F, 1.0F)}) {
    tile.inverse_depth = plane;
    cloud.tiles = {tile};
    EXPECT_THROW((void)encode(cloud, {}), std::invalid_argument) << plane.transpose();
  }
}

TEST(PlaneCloudCodec, LeavesLosslessToTheDepthImage) {
  CodecOptions options;
  options.encoding = PlaneCloudEncoding::kLossless;
  EXPECT_THROW((void)encode(corridorCloud(3), options), std::invalid_argument);
}

TEST(PlaneCloudCodec, RefusesToEncodeOverlappingAndForeignTiles) {
  PlaneCloud cloud;
  cloud.camera = testCamera();
  PlanarTile tile;
  tile.inverse_depth << 0.0F, 0.0F, 1.0F;
  tile.rect = {0, 0, 64, 64};
  cloud.tiles = {tile, tile};
  EXPECT_THROW((void)encode(cloud, {}), std::invalid_argument);
  tile.rect = {1, 0, 64, 64};
  cloud.tiles = {tile};
  EXPECT_THROW((void)encode(cloud, raw()), std::invalid_argument);
}

TEST(PlaneCloudCodec, OptionsNameKeyValueAndRange) {
  CodecOptions options;
  options.byte_budget = 10;
  try {
    (void)encode(corridorCloud(3), options);
    FAIL() << "byte_budget = 10 was accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "codec/byte_budget = 10: must be in [64, 1073741824]");
  }
  options = {};
  options.quantisation_step = 1.0;
  EXPECT_THROW(options.check(), std::invalid_argument);
}

}  // namespace
}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>

#include "planar_scene.h"
#include "planecloud_slam/plane_fit/depth_codec.h"
#include "planecloud_slam/plane_fit/fitted_depth.h"
#include "planecloud_slam/plane_fit/quadtree_fitter.h"

namespace planecloud {
namespace {

Image<float> noisyCorridor(const CameraIntrinsics& intrinsics) {
  const Camera camera(intrinsics);
  Image<float> depth = renderCorridor(camera);
  addSensorNoise(depth, 0.5, 1);
  return depth;
}

/// As a 16-bit image of `per_metre` counts a metre holds it.
Image<float> inCounts(Image<float> depth, float per_metre) {
  for (float& z : depth) z = std::round(z * per_metre) / per_metre;
  return depth;
}

void expectSame(const Image<float>& a, const Image<float>& b) {
  ASSERT_EQ(a.width(), b.width());
  ASSERT_EQ(a.height(), b.height());
  for (int y = 0; y < a.height(); ++y) {
    for (int x = 0; x < a.width(); ++x) {
      if (std::isnan(a(x, y))) {
        ASSERT_TRUE(std::isnan(b(x, y))) << x << " " << y;
      } else {
        ASSERT_EQ(a(x, y), b(x, y)) << x << " " << y;
      }
    }
  }
}

TEST(DepthCodec, IsExactForImagesInMillimetresAndOfTheTumBenchmark) {
  for (const CameraIntrinsics& camera :
       {testCamera(), testCamera(641, 479), testCamera(64, 48), distortedTestCamera()}) {
    for (const float per_metre : {1000.0F, 5000.0F}) {
      const Image<float> depth = inCounts(noisyCorridor(camera), per_metre);
      const EncodedPlaneCloud encoded = encodeDepth(depth.view(), camera, {});
      expectSame(depth, decodeDepth(encoded).depth);
    }
  }
}

TEST(DepthCodec, MovesOtherDepthsByHalfItsUnitAndDropsWhatIsTooFar) {
  Image<float> depth = noisyCorridor(testCamera());
  depth(3, 4) = 20.0F;
  depth(4, 4) = std::numeric_limits<float>::infinity();
  const Image<float> decoded = decodeDepth(encodeDepth(depth.view(), testCamera(), {})).depth;
  EXPECT_TRUE(std::isnan(decoded(3, 4)));
  EXPECT_TRUE(std::isnan(decoded(4, 4)));
  for (int x = 0; x < depth.width(); ++x) {
    if (std::isnan(depth(x, 9))) continue;
    EXPECT_NEAR(decoded(x, 9), depth(x, 9), 0.5 * kDepthUnit + 1e-6);
  }
}

TEST(DepthCodec, CodesTheEmptyAndTheFlatImageInAFewBytes) {
  const CameraIntrinsics camera = testCamera();
  const Image<float> none(640, 480, std::numeric_limits<float>::quiet_NaN());
  const EncodedPlaneCloud empty = encodeDepth(none.view(), camera, {});
  expectSame(none, decodeDepth(empty).depth);
  EXPECT_LT(empty.bytes.size(), 200U);
  const Image<float> wall(640, 480, 2.0F);
  const EncodedPlaneCloud flat = encodeDepth(wall.view(), camera, {});
  expectSame(wall, decodeDepth(flat).depth);
  EXPECT_LT(flat.bytes.size(), 400U);
}

TEST(DepthCodec, LetsTheReceiverFitWhatTheSenderWouldHaveSent) {
  const Image<float> depth = inCounts(noisyCorridor(testCamera()), 1000.0F);
  QuadtreeFitterOptions options;
  options.initial_tile_width = 40;
  options.acceptance = AcceptanceRule::kLinearInDepth;
  options.tolerance = 0.0625;  // exact in float32, as it travels
  options.min_fill = 0.5;
  const PlaneCloud received = decode(encodeDepth(depth.view(), testCamera(), options));
  const PlaneCloud fitted =
      QuadtreeFitter(std::make_shared<const Camera>(testCamera()), options).fit(depth.view());
  ASSERT_EQ(received.tiles.size(), fitted.tiles.size());
  EXPECT_EQ(received.layout, fitted.layout);
  for (std::size_t i = 0; i < fitted.tiles.size(); ++i) {
    ASSERT_EQ(received.tiles[i].rect, fitted.tiles[i].rect);
    ASSERT_EQ(received.tiles[i].inverse_depth, fitted.tiles[i].inverse_depth);
  }
}

TEST(DepthCodec, GivesWayToPlanesWhereItExceedsTheByteBudget) {
  const Image<float> depth = noisyCorridor(testCamera());
  QuadtreeFitter fitter(std::make_shared<const Camera>(testCamera()), {});
  const FittedDepth fitted{fitter.fit(depth.view()), depth.view(), {}};
  CodecOptions options;
  options.encoding = PlaneCloudEncoding::kLossless;
  const EncodedPlaneCloud exact = encode(fitted, options);
  EXPECT_EQ(exact.encoding, PlaneCloudEncoding::kLossless);
  options.byte_budget = static_cast<int>(exact.bytes.size()) - 1;
  const EncodedPlaneCloud planes = encode(fitted, options);
  EXPECT_EQ(planes.encoding, PlaneCloudEncoding::kCompact);
  EXPECT_LE(planes.bytes.size(), exact.bytes.size() - 1);
}

TEST(DepthCodec, RefusesAnImageOfAnotherSize) {
  const Image<float> depth(320, 240, 1.0F);
  EXPECT_THROW((void)encodeDepth(depth.view(), testCamera(), {}), std::invalid_argument);
}

}  // namespace
}  // namespace planecloud

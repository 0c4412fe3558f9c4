// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgcodecs.hpp>

#include "planecloud_slam/frontend_node/keyframe_payload.h"
#include "planecloud_slam/plane_fit/quadtree_fitter.h"

namespace planecloud {
namespace {

constexpr int kWidth = 320;
constexpr int kHeight = 240;

/// Something to see at every scale.
Image<std::uint8_t> busyGrey() {
  Image<std::uint8_t> grey(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      grey(x, y) = static_cast<std::uint8_t>(128 + 60 * std::sin(0.9 * x) * std::cos(0.05 * y) +
                                             60 * std::sin(0.003 * x * y));
    }
  }
  return grey;
}

Image<Rgb8> redImage() { return {kWidth, kHeight, Rgb8{200, 40, 20}}; }

/// Waves: many small tiles.
PlaneCloud wavyCloud() {
  const auto camera = std::make_shared<const Camera>(
      CameraIntrinsics{kWidth, kHeight, 285.0, 285.0, 159.5, 119.5, {}});
  Image<float> depth(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      depth(x, y) = 2.0F + 0.2F * std::sin(0.08F * static_cast<float>(x + 2 * y));
    }
  }
  return QuadtreeFitter(camera, {}).fit(depth.view());
}

TEST(KeyframeTexture, IsAnImageOfTheWishedScale) {
  const Image<std::uint8_t> grey = busyGrey();
  TextureOptions options;
  options.scale = 0.25;
  const KeyframeTexture texture = encodeTexture(grey.view(), {}, options);
  EXPECT_EQ(texture.format, "jpeg-grey");
  const cv::Mat decoded = cv::imdecode(texture.bytes, cv::IMREAD_UNCHANGED);
  EXPECT_EQ(decoded.size(), cv::Size(80, 60));
  EXPECT_EQ(decoded.channels(), 1);
}

TEST(KeyframeTexture, KeepsColours) {
  const Image<std::uint8_t> grey = busyGrey();
  const Image<Rgb8> color = redImage();
  TextureOptions options;
  options.format = TextureFormat::kColor;
  const KeyframeTexture texture = encodeTexture(grey.view(), color.view(), options);
  EXPECT_EQ(texture.format, "jpeg-color");
  const auto pixel = cv::imdecode(texture.bytes, cv::IMREAD_COLOR).at<cv::Vec3b>(10, 10);
  EXPECT_NEAR(pixel[2], 200, 8) << "red, as far as JPEG keeps it";
  EXPECT_NEAR(pixel[0], 20, 8) << "blue";
}

TEST(KeyframeTexture, IsGreyWhereTheCameraHasNoColour) {
  const Image<std::uint8_t> grey = busyGrey();
  TextureOptions options;
  options.format = TextureFormat::kColor;
  EXPECT_EQ(encodeTexture(grey.view(), {}, options).format, "jpeg-grey");
}

TEST(KeyframeTexture, ShrinksUntilItFitsOrStaysAway) {
  const Image<std::uint8_t> grey = busyGrey();
  TextureOptions options;
  options.scale = 1.0;
  std::size_t last = 0;
  for (const std::size_t most : {100U, 700U, 1500U, 4000U, 1000000U}) {
    const KeyframeTexture texture = encodeTexture(grey.view(), {}, options, most);
    EXPECT_LE(texture.bytes.size(), most);
    EXPECT_GE(texture.bytes.size(), last) << "a larger budget, a smaller texture";
    EXPECT_EQ(texture.bytes.empty(), texture.format.empty());
    last = texture.bytes.size();
  }
  EXPECT_TRUE(encodeTexture(grey.view(), {}, options, 100).bytes.empty());
}

TEST(KeyframePayload, PlanesAndTextureKeepToOneBudget) {
  const PlaneCloud cloud = wavyCloud();
  const Image<std::uint8_t> grey = busyGrey();
  PayloadOptions options;
  options.texture.scale = 0.5;
  for (const int budget : {300, 500, 1000, 2000, 4000, 8000, 50000}) {
    options.codec.byte_budget = budget;
    const KeyframePayload payload = encodePayload({cloud, {}, {}}, {grey.view(), {}}, options);
    EXPECT_LE(payload.bytes(), static_cast<std::size_t>(budget));
    EXPECT_LE(static_cast<double>(payload.texture.bytes.size()),
              options.texture.max_share * budget);
    EXPECT_GT(payload.planes.plane_count, 0U) << budget << " B";
  }
}

TEST(KeyframePayload, TheTighterOfTwoBudgetsHolds) {
  const PlaneCloud cloud = wavyCloud();
  const Image<std::uint8_t> grey = busyGrey();
  PayloadOptions options;
  options.codec.byte_budget = 4000;
  const TextureSource images{grey.view(), {}};
  EXPECT_LE(encodePayload({cloud, {}, {}}, images, options, 900).bytes(), 900U);
  EXPECT_LE(encodePayload({cloud, {}, {}}, images, options, 100'000).bytes(), 4000U);
  options.codec.byte_budget = 0;
  EXPECT_LE(encodePayload({cloud, {}, {}}, images, options, 900).bytes(), 900U);
  EXPECT_GT(encodePayload({cloud, {}, {}}, images, options).bytes(), 900U);
}

}  // namespace
}  // namespace planecloud

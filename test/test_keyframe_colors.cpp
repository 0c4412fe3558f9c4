// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "planecloud_slam/backend_node/keyframe_colors.h"

namespace planecloud {
namespace {

constexpr Rgb8 kOtherwise{1, 2, 3};

/// A keyframe of 64 x 48 pixels, its left half red, its right half blue.
Keyframe twoColors(const cv::Size& texture_size = {32, 24}) {
  cv::Mat picture(texture_size, CV_8UC3, cv::Scalar(0, 0, 255));
  picture.colRange(texture_size.width / 2, texture_size.width) = cv::Scalar(255, 0, 0);
  Keyframe keyframe;
  keyframe.planes.camera = {64, 48, 50.0, 50.0, 31.5, 23.5, {}};
  keyframe.texture.format = "jpeg-color";
  cv::imencode(".jpg", picture, keyframe.texture.bytes);
  return keyframe;
}

TEST(KeyframeColors, AreThoseThatTheCameraSaw) {
  const KeyframeColors colors(twoColors());
  ASSERT_FALSE(colors.empty());
  const Rgb8 left = colors.at({-0.5, 0.1, 2.0}, kOtherwise);
  EXPECT_GT(left.r, 230);
  EXPECT_LT(left.b, 25);
  const Rgb8 right = colors.at({0.5, 0.1, 2.0}, kOtherwise);
  EXPECT_GT(right.b, 230);
  EXPECT_LT(right.r, 25);
}

TEST(KeyframeColors, GoOnBeyondTheBorder) {
  const KeyframeColors colors(twoColors());
  EXPECT_GT(colors.at({-50.0, 0.0, 1.0}, kOtherwise).r, 230);
  EXPECT_GT(colors.at({50.0, 0.0, 1.0}, kOtherwise).b, 230);
}

TEST(KeyframeColors, AreTheRobotsWithoutTexture) {
  Keyframe keyframe = twoColors();
  keyframe.texture = {};
  const KeyframeColors colors(keyframe);
  EXPECT_TRUE(colors.empty());
  EXPECT_EQ(colors.at({0.0, 0.0, 1.0}, kOtherwise).g, kOtherwise.g);
}

TEST(KeyframeColors, RefuseWhatIsNoJpegAndWhatIsLargerThanTheView) {
  EXPECT_TRUE(KeyframeColors(twoColors({128, 24})).empty());
  const Keyframe good = twoColors();
  for (std::size_t length = 0; length < good.texture.bytes.size(); length += 7) {
    Keyframe cut = good;
    cut.texture.bytes.resize(length);
    EXPECT_NO_THROW(KeyframeColors{cut}) << length << " bytes";
  }
  Keyframe announced = good;
  for (std::size_t i = 0; i + 9 < announced.texture.bytes.size(); ++i) {
    if (announced.texture.bytes[i] != 0xFF || announced.texture.bytes[i + 1] != 0xC0) continue;
    announced.texture.bytes[i + 5] = announced.texture.bytes[i + 7] = 0xFF;  // 65 thousand a side
  }
  EXPECT_TRUE(KeyframeColors(announced).empty());
}

}  // namespace
}  // namespace planecloud

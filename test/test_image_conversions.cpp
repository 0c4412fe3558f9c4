// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <random>

#include "expect_error.h"
#include "planecloud_slam/planecloud_msgs/image_conversions.h"

namespace planecloud {
namespace {

/// A `width` x 2 image whose rows hold `numbers` and then `padding` bytes.
template <typename Number>
sensor_msgs::Image imageOf(const std::string& encoding, const std::vector<Number>& numbers,
                           std::uint32_t channels = 1, std::uint32_t padding = 0) {
  sensor_msgs::Image message;
  message.encoding = encoding;
  message.height = 2;
  const std::size_t row_bytes = numbers.size() / 2 * sizeof(Number);
  message.width = static_cast<std::uint32_t>(numbers.size()) / 2 / channels;
  message.step = static_cast<std::uint32_t>(row_bytes) + padding;
  message.data.assign(std::size_t{message.step} * 2, 0xAB);
  for (std::size_t y = 0; y < 2; ++y) {
    std::memcpy(&message.data[y * message.step], &numbers[y * numbers.size() / 2], row_bytes);
  }
  return message;
}

std::vector<std::uint8_t> randomBytes(std::size_t count) {
  std::mt19937 random(7);
  std::vector<std::uint8_t> bytes(count);
  for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
  return bytes;
}

TEST(ImageConversions, ReadMillimetresAndTakeZeroAsNone) {
  const Image<float> depth =
      depthFromMessage(imageOf<std::uint16_t>("16UC1", {0, 1000, 2345, 65535}, 1, 6));
  ASSERT_EQ(depth.width(), 2);
  ASSERT_EQ(depth.height(), 2);
  EXPECT_TRUE(std::isnan(depth(0, 0)));
  EXPECT_FLOAT_EQ(depth(1, 0), 1.0F);
  EXPECT_FLOAT_EQ(depth(0, 1), 2.345F);
  EXPECT_FLOAT_EQ(depth(1, 1), 65.535F);
}

TEST(ImageConversions, ReadMetresAndTakeWhatIsNoDistanceAsNone) {
  const float inf = std::numeric_limits<float>::infinity();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const Image<float> depth =
      depthFromMessage(imageOf<float>("32FC1", {nan, inf, 0.0F, -1.0F, 2.5F, 0.4F}));
  for (int x = 0; x < 3; ++x) EXPECT_TRUE(std::isnan(depth(x, 0)));
  EXPECT_TRUE(std::isnan(depth(0, 1)));
  EXPECT_EQ(depth(1, 1), 2.5F);
  EXPECT_EQ(depth(2, 1), 0.4F);
}

TEST(ImageConversions, ReadTheOtherByteOrder) {
  sensor_msgs::Image message = imageOf<std::uint16_t>("16UC1", {0x0102, 0x0304, 0, 0x0506});
  message.is_bigendian = message.is_bigendian == 0 ? 1 : 0;
  const Image<float> depth = depthFromMessage(message);
  EXPECT_FLOAT_EQ(depth(0, 0), 0.001F * 0x0201);
  EXPECT_TRUE(std::isnan(depth(0, 1)));
  EXPECT_FLOAT_EQ(depth(1, 1), 0.001F * 0x0605);
}

TEST(ImageConversions, GiveOpenCvsGreyBitForBit) {
  constexpr std::uint32_t kWidth = 4099;
  const struct {
    const char* encoding;
    std::uint32_t channels;
    int type, code;
  } cases[] = {{"rgb8", 3, CV_8UC3, cv::COLOR_RGB2GRAY},
               {"bgr8", 3, CV_8UC3, cv::COLOR_BGR2GRAY},
               {"rgba8", 4, CV_8UC4, cv::COLOR_RGBA2GRAY},
               {"bgra8", 4, CV_8UC4, cv::COLOR_BGRA2GRAY}};
  for (const auto& c : cases) {
    std::vector<std::uint8_t> bytes = randomBytes(2 * kWidth * c.channels);
    cv::Mat expected;
    cv::cvtColor(cv::Mat(2, kWidth, c.type, bytes.data()), expected, c.code);
    const Image<std::uint8_t> grey =
        greyFromMessage(imageOf<std::uint8_t>(c.encoding, bytes, c.channels, 5));
    ASSERT_EQ(grey.width(), static_cast<int>(kWidth));
    for (int y = 0; y < 2; ++y) {
      EXPECT_EQ(std::memcmp(grey.row(y), expected.ptr(y), kWidth), 0) << c.encoding;
    }
  }
}

TEST(ImageConversions, TakeGreyAsItIs) {
  const Image<std::uint8_t> grey = greyFromMessage(imageOf<std::uint8_t>("mono8", {1, 2, 3, 255}));
  EXPECT_EQ(grey(0, 0), 1);
  EXPECT_EQ(grey(1, 1), 255);
  const Image<std::uint8_t> deep =
      greyFromMessage(imageOf<std::uint16_t>("mono16", {0x1234, 0xFFFF, 0, 0x00FF}));
  EXPECT_EQ(deep(0, 0), 0x12);
  EXPECT_EQ(deep(1, 0), 0xFF);
  EXPECT_EQ(deep(1, 1), 0);
}

TEST(ImageConversions, NameAnUnknownEncodingAndTheKnownOnes) {
  const sensor_msgs::Image image = imageOf<std::uint8_t>("bayer_rggb8", {1, 2, 3, 4});
  expectError<MessageError>([&] { static_cast<void>(greyFromMessage(image)); },
                            {"'bayer_rggb8'", "rgb8, bgr8", "mono8"});
  expectError<MessageError>([&] { static_cast<void>(depthFromMessage(image)); },
                            {"'bayer_rggb8'", "16UC1 (mm) or 32FC1 (m)"});
}

TEST(ImageConversions, RefuseImagesWhoseBytesDoNotFitTheirSize) {
  sensor_msgs::Image image = imageOf<std::uint16_t>("16UC1", {1, 2, 3, 4});
  image.data.pop_back();
  expectError<MessageError>([&] { static_cast<void>(depthFromMessage(image)); },
                            {"2 x 2", "7 bytes", "must be 8", "truncated"});
  image.step = 3;
  expectError<MessageError>([&] { static_cast<void>(depthFromMessage(image)); }, {"row step of 3"});
  image.width = 0;
  expectError<MessageError>([&] { static_cast<void>(depthFromMessage(image)); }, {"0 x 2"});
  image.width = 0xFFFFFFFFU;
  expectError<MessageError>([&] { static_cast<void>(depthFromMessage(image)); }, {"[1, 8192]"});
}

sensor_msgs::CameraInfo someCameraInfo() {
  sensor_msgs::CameraInfo info;
  info.width = 640;
  info.height = 480;
  info.distortion_model = "plumb_bob";
  info.D = {0.1, -0.2, 0.001, 0.002, 0.3};
  info.K = {517.3, 0, 318.6, 0, 516.5, 255.3, 0, 0, 1};
  info.P = {510.0, 0, 320.0, 0, 0, 511.0, 250.0, 0, 0, 0, 1, 0};
  return info;
}

TEST(ImageConversions, TakeRawCamerasFromKAndDAndRectifiedOnesFromP) {
  const CameraIntrinsics raw = fromMessage(someCameraInfo(), false);
  EXPECT_EQ(raw, (CameraIntrinsics{
                     640, 480, 517.3, 516.5, 318.6, 255.3, {0.1, -0.2, 0.001, 0.002, 0.3}}));
  const CameraIntrinsics rectified = fromMessage(someCameraInfo(), true);
  EXPECT_EQ(rectified, (CameraIntrinsics{640, 480, 510.0, 511.0, 320.0, 250.0, {}}));
}

TEST(ImageConversions, RefuseCamerasThatCannotBeUsedNamingTheCure) {
  const auto expectRefused = [](sensor_msgs::CameraInfo info, const std::string& part) {
    expectError<MessageError>([&] { static_cast<void>(fromMessage(info, false)); }, {part});
  };
  sensor_msgs::CameraInfo info = someCameraInfo();
  info.K[0] = 0.0;
  expectRefused(info, "calibrate");
  info = someCameraInfo();
  info.distortion_model = "equidistant";
  expectRefused(info, "'plumb_bob'");
  info = someCameraInfo();
  info.binning_x = 2;
  expectRefused(info, "full image");
  info = someCameraInfo();
  info.width = 0xFFFFFFFFU;
  expectRefused(info, "width");
  info = someCameraInfo();
  info.K[2] = std::numeric_limits<double>::quiet_NaN();
  expectRefused(info, "cx");
}

}  // namespace
}  // namespace planecloud

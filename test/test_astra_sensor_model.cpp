// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <vector>

#include "planecloud_slam/rosbags/astra_sensor_model.h"

namespace planecloud {
namespace {

constexpr double kFocalBaseline = 570.0 * 0.075;  // [px m]
constexpr int kWidth = 320;
constexpr int kHeight = 240;

/// A grey scene whose depth is a function of the pixel, facing the sensor.
RenderedView sceneOf(const std::function<float(int x, int y)>& depth) {
  RenderedView view;
  view.color = Image<Eigen::Array3f>(kWidth, kHeight, Eigen::Array3f::Constant(128.0F));
  view.depth = Image<float>(kWidth, kHeight);
  view.incidence = Image<float>(kWidth, kHeight, 1.0F);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) view.depth(x, y) = depth(x, y);
  }
  return view;
}

RenderedView wallAt(float depth) {
  return sceneOf([=](int, int) { return depth; });
}

/// Error of the disparity in each pixel [px]; every pixel must have answered.
Image<double> disparityErrors(const Image<std::uint16_t>& sensed, const RenderedView& view) {
  Image<double> errors(kWidth, kHeight);
  for (std::size_t i = 0; i < errors.size(); ++i) {
    EXPECT_GT(sensed.begin()[i], 0);
    errors.begin()[i] = kFocalBaseline / (1e-3 * sensed.begin()[i]) -
                        kFocalBaseline / double{view.depth.begin()[i]};
  }
  return errors;
}

double correlation(const Image<double>& values, int lag) {
  double products = 0.0;
  double squares = 0.0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x + lag < kWidth; ++x) {
      products += values(x, y) * values(x + lag, y);
      squares += values(x, y) * values(x, y);
    }
  }
  return products / squares;
}

double deviation(const Image<double>& values) {
  double squares = 0.0;
  for (const double value : values) squares += value * value;
  return std::sqrt(squares / static_cast<double>(values.size()));
}

TEST(AstraSensorModel, DisparityNoiseIsThePublishedOneAtEveryDepth) {
  const AstraSensorModel sensor;
  for (const float depth : {0.8F, 1.5F, 3.0F, 5.0F, 6.5F}) {
    const RenderedView view = wallAt(depth);
    const double noise = deviation(disparityErrors(sensor.senseDepth(view, {7, 1, 0.0}), view));
    EXPECT_GE(noise, 0.15) << depth;
    EXPECT_LE(noise, 0.30) << depth;
  }
}

TEST(AstraSensorModel, DepthNoiseGrowsWithTheSquareOfDepth) {
  const AstraSensorModel sensor;
  const auto depthNoise = [&](float depth) {
    const Image<std::uint16_t> sensed = sensor.senseDepth(wallAt(depth), {7, 1, 0.0});
    double squares = 0.0;
    for (const std::uint16_t z : sensed) squares += std::pow(1e-3 * z - double{depth}, 2);
    return std::sqrt(squares / static_cast<double>(sensed.size()));
  };
  const double exponent = std::log(depthNoise(6.0F) / depthNoise(1.0F)) / std::log(6.0);
  // A little above 2: far surfaces return less light.
  EXPECT_NEAR(exponent, 2.1, 0.15);
}

TEST(AstraSensorModel, NoiseIsCorrelatedOverAboutFivePixels) {
  const RenderedView view = wallAt(3.0F);
  const Image<double> errors =
      disparityErrors(AstraSensorModel().senseDepth(view, {7, 1, 0.0}), view);
  EXPECT_GT(correlation(errors, 1), 0.7);
  EXPECT_GT(correlation(errors, 3), 0.25);
  EXPECT_LT(correlation(errors, 5), 0.2);
  EXPECT_NEAR(correlation(errors, 9), 0.0, 0.05);
}

TEST(AstraSensorModel, DisparityIsQuantisedInEighthsOfAPixel) {
  for (const double depth : {1.0, 2.0, 4.0}) {
    const Image<std::uint16_t> sensed =
        AstraSensorModel().senseDepth(wallAt(static_cast<float>(depth)), {7, 1, 0.0});
    const std::set<std::uint16_t> values(sensed.begin(), sensed.end());
    ASSERT_GT(values.size(), 4U);
    std::vector<double> steps;
    for (auto next = std::next(values.begin()); next != values.end(); ++next) {
      steps.push_back(1e-3 * (*next - *std::prev(next)));
    }
    std::nth_element(steps.begin(), steps.begin() + static_cast<long>(steps.size() / 2),
                     steps.end());
    // A step of 2.9e-3 z^2 m, rounded to millimetres.
    EXPECT_NEAR(steps[steps.size() / 2], 0.125 * depth * depth / kFocalBaseline, 1.1e-3) << depth;
  }
}

TEST(AstraSensorModel, SeesNothingOutOfItsRange) {
  const AstraSensorModel sensor;
  for (const float depth : {0.3F, 9.0F}) {
    for (const std::uint16_t z : sensor.senseDepth(wallAt(depth), {7, 1, 0.0})) ASSERT_EQ(z, 0);
  }
}

TEST(AstraSensorModel, LeavesAShadowLeftOfANearerObject) {
  constexpr int kEdge = 160;
  const RenderedView view = sceneOf([](int x, int) { return x < kEdge ? 3.0F : 1.0F; });
  const Image<std::uint16_t> sensed = AstraSensorModel().senseDepth(view, {7, 1, 0.0});
  // The disparities differ by 28.5 px of a 640 px row.
  const int width = static_cast<int>(0.5 * kFocalBaseline * (1.0 - 1.0 / 3.0));
  for (int y = 0; y < kHeight; y += 10) {
    for (int x = kEdge - width + 1; x < kEdge - 1; ++x) ASSERT_EQ(sensed(x, y), 0) << x;
    EXPECT_GT(sensed(kEdge - width - 4, y), 0);
    EXPECT_GT(sensed(kEdge + 4, y), 0);
  }
}

TEST(AstraSensorModel, GrazingSurfacesAndGlassGiveNoAnswer) {
  RenderedView view = wallAt(2.0F);
  std::fill(view.incidence.begin(), view.incidence.end(), 0.03F);
  for (const std::uint16_t z : AstraSensorModel().senseDepth(view, {7, 1, 0.0})) ASSERT_EQ(z, 0);
  std::fill(view.incidence.begin(), view.incidence.end(), 0.0F);
  for (const std::uint16_t z : AstraSensorModel().senseDepth(view, {7, 1, 0.0})) ASSERT_EQ(z, 0);
}

TEST(AstraSensorModel, ColourNoiseIsAboutOneGreyLevel) {
  const SensorFrame frame{7, 3, 2.0};
  const Image<Rgb8> color = AstraSensorModel().senseColor(wallAt(2.0F), frame);
  double squares = 0.0;
  const double mean = 128.0 * AstraSensorModel().exposure(frame);
  for (const Rgb8& pixel : color) squares += std::pow(pixel.g - mean, 2);
  const double noise = std::sqrt(squares / static_cast<double>(color.size()));
  EXPECT_NEAR(noise, 1.15, 0.1);  // 1.1 and the rounding to bytes
}

TEST(AstraSensorModel, ExposureDriftsSlowly) {
  const AstraSensorModel sensor;
  double low = 2.0;
  double high = 0.0;
  for (int i = 0; i < 1200; ++i) {
    const double now = sensor.exposure({7, 0, i / 15.0});
    const double then = sensor.exposure({7, 0, (i + 1) / 15.0});
    ASSERT_LT(std::abs(now - then), 0.003);  // less than half a grey level per frame
    low = std::min(low, now);
    high = std::max(high, now);
  }
  EXPECT_GT(high - low, 0.05);
  EXPECT_LT(high - low, 0.15);
}

TEST(AstraSensorModel, NoiseBelongsToSeedAndFrame) {
  const AstraSensorModel sensor;
  const RenderedView view = wallAt(2.0F);
  const auto equal = [&](const SensorFrame& a, const SensorFrame& b) {
    const Image<std::uint16_t> first = sensor.senseDepth(view, a);
    const Image<std::uint16_t> second = sensor.senseDepth(view, b);
    return std::equal(first.begin(), first.end(), second.begin());
  };
  EXPECT_TRUE(equal({7, 1, 0.0}, {7, 1, 0.0}));
  EXPECT_FALSE(equal({7, 1, 0.0}, {7, 2, 0.0}));
  EXPECT_FALSE(equal({7, 1, 0.0}, {8, 1, 0.0}));
}

}  // namespace
}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "planecloud_slam/plane_fit/appearance_descriptor.h"

namespace planecloud {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

/// A view of a made-up place: waves of brightness and depth, the same for the same seed.
struct View {
  Image<std::uint8_t> grey;
  Image<float> depth;
};

View lookAt(unsigned place, int pan_pixels = 0, double contrast = 40.0) {
  std::mt19937 random(place);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::array<std::array<double, 4>, 6> waves{};
  for (std::array<double, 4>& wave : waves) {
    wave = {0.02 * uniform(random), 0.02 * uniform(random), 3.1 * uniform(random), uniform(random)};
  }
  View view{Image<std::uint8_t>(320, 240), Image<float>(320, 240)};
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 320; ++x) {
      double sums[2] = {0.0, 0.0};
      for (std::size_t i = 0; i < waves.size(); ++i) {
        const std::array<double, 4>& w = waves[i];
        sums[i % 2] += w[3] * std::sin(2.0 * (w[0] * (x + pan_pixels) + w[1] * y) + w[2]);
      }
      view.grey(x, y) =
          static_cast<std::uint8_t>(std::clamp(128.0 + contrast * sums[0], 0.0, 255.0));
      view.depth(x, y) = static_cast<float>(2.5 * std::exp(0.4 * sums[1]));
    }
  }
  return view;
}

std::vector<std::uint8_t> describe(const View& view) {
  return makeAppearanceDescriptor(view.grey.view(), view.depth.view());
}

double difference(const View& a, const View& b) {
  return appearanceDissimilarity(describe(a), describe(b)).value();
}

TEST(AppearanceDescriptor, TakesUnder300Bytes) { EXPECT_EQ(describe(lookAt(1)).size(), 241U); }

TEST(AppearanceDescriptor, IsNearForTheSameViewUnderNoiseAndExposure) {
  std::mt19937 random(1);
  std::normal_distribution<double> gauss;
  for (unsigned place = 0; place < 20; ++place) {
    const View view = lookAt(place);
    View changed = view;
    for (std::uint8_t& value : changed.grey) {
      value = static_cast<std::uint8_t>(
          std::clamp(0.7 * value + 20.0 + 5.0 * gauss(random), 0.0, 255.0));
    }
    for (float& z : changed.depth) z += static_cast<float>(0.003 * z * z * gauss(random));
    EXPECT_LT(difference(view, changed), 0.05) << place;
  }
}

TEST(AppearanceDescriptor, IsFarForDifferentPlaces) {
  double sum = 0.0;
  int close = 0;
  for (unsigned place = 0; place < 40; ++place) {
    const double value = difference(lookAt(place), lookAt(place + 100));
    sum += value;
    close += value < 0.3 ? 1 : 0;
  }
  // Smooth waves resemble each other more than rooms do once they may be shifted.
  EXPECT_GT(sum / 40.0, 0.45);
  EXPECT_LE(close, 4);
}

TEST(AppearanceDescriptor, TellsBareWallsApartByTheirDepth) {
  View bare = lookAt(1);
  View same = lookAt(1);
  View other = lookAt(2);
  for (View* view : {&bare, &same, &other}) {
    std::fill(view->grey.begin(), view->grey.end(), std::uint8_t{150});
  }
  EXPECT_GT(difference(bare, other), difference(bare, same) + 0.05);
}

TEST(AppearanceDescriptor, FindsTheShiftOfATurnedView) {
  const AppearanceComparison comparison =
      compareAppearance(describe(lookAt(3)), describe(lookAt(3, 64))).value();
  EXPECT_LT(comparison.dissimilarity, 0.1);
  // The second view lies 64 of 320 pixels further right, so it shows things further left.
  EXPECT_NEAR(comparison.shift_x, 0.2, 1e-9);
  EXPECT_EQ(comparison.shift_y, 0.0);
}

TEST(AppearanceDescriptor, ComparesAlikeBothWaysRound) {
  for (unsigned place = 0; place < 10; ++place) {
    const std::vector<std::uint8_t> a = describe(lookAt(place));
    const std::vector<std::uint8_t> b = describe(lookAt(place, 30));
    const AppearanceComparison forward = compareAppearance(a, b).value();
    const AppearanceComparison backward = compareAppearance(b, a).value();
    EXPECT_EQ(forward.dissimilarity, backward.dissimilarity);
    EXPECT_EQ(forward.shift_x, -backward.shift_x);
    EXPECT_EQ(forward.shift_y, -backward.shift_y);
  }
  // Not zero: a little variance is added against noise on bare walls.
  EXPECT_LT(difference(lookAt(1), lookAt(1)), 0.05);
}

TEST(AppearanceDescriptor, WorksWithoutDepth) {
  const View first = lookAt(1);
  const View second = lookAt(101);
  const auto blind = [](const View& view) {
    return makeAppearanceDescriptor(view.grey.view(), ImageView<float>());
  };
  EXPECT_LT(appearanceDissimilarity(blind(first), blind(first)).value(), 0.05);
  EXPECT_GT(appearanceDissimilarity(blind(first), blind(second)).value(), 0.1);
  View holes = first;
  std::fill(holes.depth.begin(), holes.depth.end(), kNone);
  EXPECT_EQ(describe(holes), blind(first));
  std::fill(holes.depth.begin(), holes.depth.end(), 0.0F);
  EXPECT_EQ(describe(holes), blind(first));
}

TEST(AppearanceDescriptor, IsNotSimilarToABlackImage) {
  View black = lookAt(1);
  std::fill(black.grey.begin(), black.grey.end(), std::uint8_t{0});
  std::fill(black.depth.begin(), black.depth.end(), kNone);
  EXPECT_GT(difference(lookAt(1), black), 0.9);
  EXPECT_GT(difference(black, black), 0.9) << "two black images say nothing of a place";
}

TEST(AppearanceDescriptor, DoesNotDependOnTheSizeOfTheImages) {
  const View view = lookAt(4);
  Image<std::uint8_t> half(160, 120);
  for (int y = 0; y < 120; ++y) {
    for (int x = 0; x < 160; ++x) half(x, y) = view.grey(2 * x, 2 * y);
  }
  const std::optional<double> value = appearanceDissimilarity(
      describe(view), makeAppearanceDescriptor(half.view(), view.depth.view()));
  EXPECT_LT(value.value(), 0.05);  // as a view against itself
}

TEST(AppearanceDescriptor, GivesNothingForMalformedBytes) {
  const std::vector<std::uint8_t> good = describe(lookAt(1));
  EXPECT_TRUE(makeAppearanceDescriptor(ImageView<std::uint8_t>(), ImageView<float>()).empty());
  std::vector<std::uint8_t> foreign = good;
  foreign[0] = 99;
  std::vector<std::uint8_t> truncated = good;
  truncated.pop_back();
  std::vector<std::uint8_t> impossible = good;
  impossible[7] = 0xf0;  // brightness 0 is never written
  for (const std::vector<std::uint8_t>& bad :
       {std::vector<std::uint8_t>(), foreign, truncated, impossible}) {
    EXPECT_FALSE(appearanceDissimilarity(good, bad).has_value());
    EXPECT_FALSE(appearanceDissimilarity(bad, good).has_value());
  }
}

TEST(AppearanceDescriptor, KeepsTheMeaningOfItsVersion) {
  // A ramp from dark to bright at 2 m: frozen cells of version 1.
  Image<std::uint8_t> grey(200, 120);
  for (int y = 0; y < 120; ++y) {
    for (int x = 0; x < 200; ++x) grey(x, y) = static_cast<std::uint8_t>(x);
  }
  const Image<float> depth(200, 120, 2.0F);
  const std::vector<std::uint8_t> bytes = makeAppearanceDescriptor(grey.view(), depth.view());
  ASSERT_EQ(bytes.size(), 241U);
  EXPECT_EQ(bytes[0], 1);
  EXPECT_EQ(bytes[1], 0x93);   // 1.65 deviations below the mean, ln(2 / 0.4) / 0.214 = 8th step
  EXPECT_EQ(bytes[20], 0x9d);  // as much above
  EXPECT_EQ(bytes[240], 0x9d);
}

}  // namespace
}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "planecloud_slam/rosbags/hallway_surfaces.h"
#include "planecloud_slam/rosbags/hallway_texture.h"

namespace planecloud {
namespace {

/// One texel black, the next white.
MipTexture<std::uint8_t> chessboard() {
  Image<std::uint8_t> board(64, 64);
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) board(x, y) = (x + y) % 2 == 0 ? 0 : 255;
  }
  return MipTexture<std::uint8_t>(board);
}

TEST(MipTexture, ShowsItsTexelsFromNear) {
  const MipTexture<std::uint8_t> board = chessboard();
  EXPECT_FLOAT_EQ(board.sampleFinest({0.5F, 0.5F}), 0.0F);
  EXPECT_FLOAT_EQ(board.sampleFinest({1.5F, 0.5F}), 255.0F);
  EXPECT_FLOAT_EQ(board.sample({{1.5F, 0.5F}, {0.4F, 0.0F}, 0.4F}), 255.0F);
}

TEST(MipTexture, ShowsTheMeanFromFarInsteadOfAliasing) {
  const MipTexture<std::uint8_t> board = chessboard();
  for (const float x : {0.0F, 0.3F, 7.9F}) {
    // Within one grey level: levels are rounded to bytes.
    EXPECT_NEAR(board.sample({{x, 3.1F}, {4.0F, 0.0F}, 4.0F}), 127.5F, 1.0F);
  }
}

TEST(MipTexture, RepeatsInBothDirections) {
  const MipTexture<std::uint8_t> paint = makePaintTexture(3);
  const auto side = static_cast<float>(paint.side());
  EXPECT_FLOAT_EQ(paint.sampleFinest({10.25F, 20.5F}),
                  paint.sampleFinest({10.25F - side, 20.5F + 2.0F * side}));
}

TEST(MipTexture, RefusesASideThatIsNoPowerOfTwo) {
  EXPECT_THROW(MipTexture<std::uint8_t>(Image<std::uint8_t>(48, 48)), std::invalid_argument);
  EXPECT_THROW(MipTexture<std::uint8_t>(Image<std::uint8_t>(64, 32)), std::invalid_argument);
}

TEST(HallwaySurfaces, PostersOfDifferentSeedsDiffer) {
  const MipTexture<Rgb8> a = makePosterTexture(1);
  const MipTexture<Rgb8> b = makePosterTexture(2);
  double difference = 0.0;
  for (float y = 0.5F; y < 256.0F; y += 8.0F) {
    for (float x = 0.5F; x < 256.0F; x += 8.0F) {
      difference += (a.sampleFinest({x, y}) - b.sampleFinest({x, y})).abs().maxCoeff() / 1024.0;
    }
  }
  EXPECT_GT(difference, 30.0);  // grey levels on average: nobody would mix them up
}

}  // namespace
}  // namespace planecloud

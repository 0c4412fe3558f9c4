// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "planecloud_slam/plane_fit/integer_model.h"
#include "planecloud_slam/plane_fit/range_coder.h"

namespace planecloud {
namespace {

TEST(RangeCoder, ReturnsEveryBitOfSkewedAndRawSources) {
  for (const double skew : {0.001, 0.1, 0.5, 0.999}) {
    std::mt19937 random(11);
    std::bernoulli_distribution bit(skew);
    std::vector<bool> bits;
    std::vector<std::uint32_t> raw;
    for (int i = 0; i < 20000; ++i) {
      bits.push_back(bit(random));
      raw.push_back(static_cast<std::uint32_t>(random()) & 7U);
    }
    std::vector<std::uint8_t> bytes;
    RangeEncoder encoder(bytes);
    AdaptiveBit model;
    for (std::size_t i = 0; i < bits.size(); ++i) {
      encoder.code(bits[i], model);
      if (i % 16 == 0) encoder.codeRaw(raw[i], 3);
    }
    encoder.finish();
    RangeDecoder decoder(bytes.data(), bytes.size());
    AdaptiveBit decoder_model;
    for (std::size_t i = 0; i < bits.size(); ++i) {
      ASSERT_EQ(decoder.code(false, decoder_model), bits[i]) << i;
      if (i % 16 == 0) {
        ASSERT_EQ(decoder.codeRaw(0, 3), raw[i]);
      }
    }
    EXPECT_TRUE(decoder.atEnd());
  }
}

TEST(RangeCoder, ComesNearTheEntropy) {
  std::mt19937 random(12);
  std::bernoulli_distribution bit(0.05);
  std::vector<std::uint8_t> bytes;
  RangeEncoder encoder(bytes);
  AdaptiveBit model;
  constexpr int kCount = 100000;
  for (int i = 0; i < kCount; ++i) encoder.code(bit(random), model);
  encoder.finish();
  const double entropy = -(0.05 * std::log2(0.05) + 0.95 * std::log2(0.95)) * kCount / 8.0;
  // The fast estimate's jitter costs some 4 %.
  EXPECT_LT(static_cast<double>(bytes.size()), 1.06 * entropy);
}

TEST(RangeCoder, KnowsTheBitsWhileCoding) {
  std::mt19937 random(13);
  std::vector<std::uint8_t> bytes{1, 2, 3};
  RangeEncoder encoder(bytes);
  AdaptiveBit model;
  const double begin = encoder.bitsSoFar();
  double last = begin;
  for (int i = 0; i < 5000; ++i) {
    encoder.code(random() % 3 == 0, model);
    EXPECT_GT(encoder.bitsSoFar(), last);
    last = encoder.bitsSoFar();
  }
  encoder.finish();
  // The end takes up to 4 bytes, less the zeros that are left out.
  EXPECT_NEAR(last - begin, 8.0 * static_cast<double>(bytes.size() - 3), 32.0);
}

TEST(RangeCoder, EmptyStreamIsEmpty) {
  std::vector<std::uint8_t> bytes;
  RangeEncoder encoder(bytes);
  encoder.finish();
  EXPECT_TRUE(bytes.empty());
  RangeDecoder decoder(bytes.data(), bytes.size());
  EXPECT_TRUE(decoder.atEnd());
}

TEST(IntegerModel, ReturnsEveryInteger) {
  std::vector<std::int32_t> values{0, 1, -1, 2, -2, 3, (1 << 26) - 1, -((1 << 26) - 1)};
  std::mt19937 random(14);
  for (int i = 0; i < 5000; ++i) {
    const int bits = static_cast<int>(random() % 26);
    const auto magnitude = static_cast<std::int32_t>(random() & ((1U << bits) - 1U));
    values.push_back(random() % 2 == 0 ? magnitude : -magnitude);
  }
  std::vector<std::uint8_t> bytes;
  RangeEncoder encoder(bytes);
  IntegerModel model;
  for (const std::int32_t value : values) ASSERT_EQ(model.code(encoder, value), value);
  encoder.finish();
  RangeDecoder decoder(bytes.data(), bytes.size());
  IntegerModel decoder_model;
  for (const std::int32_t value : values) ASSERT_EQ(decoder_model.code(decoder, 0), value);
}

}  // namespace
}  // namespace planecloud

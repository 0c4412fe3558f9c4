// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "planar_scene.h"
#include "planecloud_slam/plane_fit/plane_cloud_codec.h"
#include "planecloud_slam/plane_fit/quadtree_fitter.h"
#include "planecloud_slam/plane_fit/quadtree_grid.h"

/// The decoder faces the network: whatever the bytes, it throws PlaneCloudDecodeError or returns a
/// cloud that could have been encoded.
namespace planecloud {
namespace {

EncodedPlaneCloud sample(PlaneCloudEncoding encoding) {
  const auto camera = std::make_shared<const Camera>(testCamera(320, 240));
  Image<float> depth = renderCorridor(*camera);
  addSensorNoise(depth, 0.5, 1);
  CodecOptions options;
  options.encoding = encoding;
  return encode(QuadtreeFitter(camera, {}).fit(depth.view()), options);
}

/// CRC-16/CCITT as the stream's documentation states it, so that mutants get past the checksum.
void repairChecksum(EncodedPlaneCloud& encoded) {
  if (encoded.encoding != PlaneCloudEncoding::kCompact || encoded.bytes.size() < 2) return;
  std::vector<std::uint8_t> covered;
  for (const int side : {encoded.camera.width, encoded.camera.height}) {
    covered.push_back(static_cast<std::uint8_t>(side & 255));
    covered.push_back(static_cast<std::uint8_t>(side >> 8));
  }
  covered.insert(covered.end(), encoded.bytes.begin(), encoded.bytes.end() - 2);
  std::uint32_t crc = 0xFFFF;
  for (const std::uint8_t byte : covered) {
    crc ^= static_cast<std::uint32_t>(byte) << 8;
    for (int i = 0; i < 8; ++i) crc = (crc & 0x8000U) != 0 ? (crc << 1) ^ 0x1021U : crc << 1;
    crc &= 0xFFFFU;
  }
  encoded.bytes[encoded.bytes.size() - 2] = static_cast<std::uint8_t>(crc & 255U);
  encoded.bytes[encoded.bytes.size() - 1] = static_cast<std::uint8_t>(crc >> 8);
}

void expectValid(const PlaneCloud& cloud) {
  const QuadtreeGrid grid(cloud.layout, cloud.camera.width, cloud.camera.height);
  long area = 0;
  for (const PlanarTile& tile : cloud.tiles) {
    ASSERT_TRUE(grid.find(tile.rect));
    ASSERT_TRUE(tile.inverse_depth.allFinite());
    area += tile.rect.area();
  }
  ASSERT_LE(area, long{cloud.camera.width} * cloud.camera.height);
}

/// True when it decodes; fails the test on anything but a valid cloud or the one exception.
bool survives(const EncodedPlaneCloud& encoded) {
  try {
    expectValid(decode(encoded));
    return true;
  } catch (const PlaneCloudDecodeError& error) {
    EXPECT_EQ(std::string(error.what()).rfind("plane cloud: ", 0), 0U) << error.what();
    return false;
  }
}

TEST(PlaneCloudDecoder, RefusesEveryTruncationAndEveryExtension) {
  for (const auto encoding : {PlaneCloudEncoding::kCompact, PlaneCloudEncoding::kRaw}) {
    const EncodedPlaneCloud whole = sample(encoding);
    ASSERT_TRUE(survives(whole));
    for (std::size_t size = 0; size < whole.bytes.size(); ++size) {
      EncodedPlaneCloud part = whole;
      part.bytes.resize(size);
      ASSERT_THROW((void)decode(part), PlaneCloudDecodeError) << size;
    }
    for (const std::uint8_t byte : {0, 1, 255}) {
      EncodedPlaneCloud longer = whole;
      longer.bytes.push_back(byte);
      ASSERT_THROW((void)decode(longer), PlaneCloudDecodeError);
      longer = whole;
      longer.bytes.insert(longer.bytes.end() - 2, 3, byte);
      repairChecksum(longer);
      ASSERT_THROW((void)decode(longer), PlaneCloudDecodeError);
    }
  }
}

TEST(PlaneCloudDecoder, RefusesEverySingleBitFlipOfACompactStream) {
  const EncodedPlaneCloud whole = sample(PlaneCloudEncoding::kCompact);
  for (std::size_t bit = 0; bit < 8 * whole.bytes.size(); ++bit) {
    EncodedPlaneCloud flipped = whole;
    flipped.bytes[bit / 8] = static_cast<std::uint8_t>(flipped.bytes[bit / 8] ^ (1 << (bit % 8)));
    ASSERT_THROW((void)decode(flipped), PlaneCloudDecodeError) << bit;
  }
}

TEST(PlaneCloudDecoder, SurvivesTensOfThousandsOfMutants) {
  std::mt19937 random(21);
  for (const auto encoding : {PlaneCloudEncoding::kCompact, PlaneCloudEncoding::kRaw}) {
    const EncodedPlaneCloud whole = sample(encoding);
    int decoded = 0;
    for (int i = 0; i < 15000; ++i) {
      EncodedPlaneCloud mutant = whole;
      const unsigned changes = 1 + static_cast<unsigned>(random() % 4);
      for (unsigned change = 0; change < changes; ++change) {
        // Every other one in the header, where the counts and sizes are.
        const std::size_t reach = random() % 2 == 0 ? std::size_t{12} : mutant.bytes.size();
        mutant.bytes[random() % reach] = static_cast<std::uint8_t>(random());
      }
      if (random() % 4 == 0) mutant.bytes.resize(2 + random() % (mutant.bytes.size() - 2));
      repairChecksum(mutant);
      decoded += survives(mutant) ? 1 : 0;
      ASSERT_FALSE(testing::Test::HasFailure()) << i;
    }
    EXPECT_LT(decoded, 15000);
  }
}

TEST(PlaneCloudDecoder, SurvivesNoise) {
  std::mt19937 random(22);
  EncodedPlaneCloud noise = sample(PlaneCloudEncoding::kCompact);
  for (int i = 0; i < 3000; ++i) {
    // A plausible header, then anything.
    noise.bytes.resize(9 + random() % 400);
    for (std::size_t at = 6; at < noise.bytes.size(); ++at) {
      noise.bytes[at] = static_cast<std::uint8_t>(random());
    }
    noise.plane_count = static_cast<std::uint32_t>(random() % 200);
    noise.bytes[6] = static_cast<std::uint8_t>(noise.plane_count % 128);
    noise.plane_count %= 128;
    repairChecksum(noise);
    survives(noise);
    ASSERT_FALSE(testing::Test::HasFailure()) << i;
  }
}

TEST(PlaneCloudDecoder, RefusesImpossibleCountsVersionsAndCameras) {
  for (const auto encoding : {PlaneCloudEncoding::kCompact, PlaneCloudEncoding::kRaw}) {
    const EncodedPlaneCloud whole = sample(encoding);
    EncodedPlaneCloud bad = whole;
    bad.plane_count += 1;
    EXPECT_THROW((void)decode(bad), PlaneCloudDecodeError);
    bad = whole;
    bad.bytes[0] = static_cast<std::uint8_t>(bad.bytes[0] + 1);
    repairChecksum(bad);
    EXPECT_THROW((void)decode(bad), PlaneCloudDecodeError);
    bad = whole;
    bad.camera.width = 1 << 30;
    EXPECT_THROW((void)decode(bad), PlaneCloudDecodeError);
    bad = whole;
    bad.camera.fx = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW((void)decode(bad), PlaneCloudDecodeError);
    bad = whole;
    bad.encoding = static_cast<PlaneCloudEncoding>(99);
    EXPECT_THROW((void)decode(bad), PlaneCloudDecodeError);
    bad = whole;
    bad.encoding = encoding == PlaneCloudEncoding::kRaw ? PlaneCloudEncoding::kCompact
                                                        : PlaneCloudEncoding::kRaw;
    EXPECT_THROW((void)decode(bad), PlaneCloudDecodeError);
  }
}

TEST(PlaneCloudDecoder, ACompactStreamBelongsToItsImageSize) {
  EncodedPlaneCloud encoded = sample(PlaneCloudEncoding::kCompact);
  encoded.camera.width += 64;
  EXPECT_THROW((void)decode(encoded), PlaneCloudDecodeError);
}

TEST(PlaneCloudDecoder, SaysWhatToDoAboutAForeignVersion) {
  EncodedPlaneCloud encoded = sample(PlaneCloudEncoding::kCompact);
  encoded.bytes[0] = 0x2F;
  try {
    (void)decode(encoded);
    FAIL() << "a foreign version was decoded";
  } catch (const PlaneCloudDecodeError& error) {
    EXPECT_STREQ(error.what(),
                 "plane cloud: COMPACT version 47 is unknown here: update the receiver");
  }
}

}  // namespace
}  // namespace planecloud

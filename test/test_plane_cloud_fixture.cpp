// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "planar_scene.h"
#include "planecloud_slam/plane_fit/depth_codec.h"
#include "planecloud_slam/plane_fit/plane_cloud_codec.h"

/// Streams as they were first released: `fixtures/plane_cloud_compact_v2.bin`, with a mask (the
/// noisy corridor of planar_scene.h, distorted camera), and `fixtures/plane_cloud_lossless_v1.bin`
/// (64 x 48 pixels of it). Streams recorded then must decode to the same bits for ever, on every
/// machine: never write the files anew, add a version.
namespace planecloud {
namespace {

std::vector<std::uint8_t> readFixture(const std::string& name) {
  std::ifstream file(std::filesystem::path(__FILE__).parent_path() / "fixtures" / name,
                     std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// FNV-1a over little-endian words.
class Hash {
 public:
  void add(std::uint32_t word) {
    for (int i = 0; i < 4; ++i) {
      value_ ^= (word >> (8 * i)) & 255U;
      value_ *= 1099511628211ULL;
    }
  }
  [[nodiscard]] std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 1469598103934665603ULL;
};

/// Over all tiles: x y width height, alpha beta gamma; then the mask.
std::uint64_t hashOf(const PlaneCloud& cloud) {
  Hash hash;
  for (const PlanarTile& tile : cloud.tiles) {
    for (const int side : {tile.rect.x, tile.rect.y, tile.rect.width, tile.rect.height}) {
      hash.add(static_cast<std::uint32_t>(side));
    }
    for (int i = 0; i < 3; ++i) {
      std::uint32_t bits = 0;
      const float coefficient = tile.inverse_depth(i);
      std::memcpy(&bits, &coefficient, sizeof(bits));
      hash.add(bits);
    }
  }
  for (const std::uint8_t valid : cloud.mask) hash.add(valid);
  return hash.value();
}

EncodedPlaneCloud compactFixture() {
  EncodedPlaneCloud encoded;
  encoded.camera = distortedTestCamera();
  encoded.plane_count = 453;
  encoded.bytes = readFixture("plane_cloud_compact_v2.bin");
  return encoded;
}

TEST(PlaneCloudFixture, CompactVersion2DecodesToTheSameBits) {
  const EncodedPlaneCloud encoded = compactFixture();
  ASSERT_EQ(encoded.bytes.size(), 2408U);
  const PlaneCloud cloud = decode(encoded);
  ASSERT_EQ(cloud.tiles.size(), 453U);
  EXPECT_EQ(cloud.layout, (QuadtreeLayout{64, 64, 4}));
  const PlanarTile& tile = cloud.tiles[226];
  EXPECT_EQ(tile.rect, (TileRect{464, 352, 16, 16}));
  EXPECT_EQ(tile.inverse_depth, Eigen::Vector3f(0.0F, 0x1.0872bp-1F, 0x1.362982p-3F));
  EXPECT_EQ(hashOf(cloud), 1639385538309228767ULL);
}

TEST(PlaneCloudFixture, CompactVersion2IsWhatTheEncoderWrites) {
  const EncodedPlaneCloud encoded = compactFixture();
  CodecOptions options;
  options.quantisation_step = 2e-3;
  options.mask = true;
  EXPECT_EQ(encode(decode(encoded), options).bytes, encoded.bytes);
}

TEST(PlaneCloudFixture, LosslessVersion1DecodesToTheSameDepthAndIsWhatTheEncoderWrites) {
  EncodedPlaneCloud encoded;
  encoded.encoding = PlaneCloudEncoding::kLossless;
  encoded.camera = distortedTestCamera();
  encoded.camera.width = 64;
  encoded.camera.height = 48;
  encoded.bytes = readFixture("plane_cloud_lossless_v1.bin");
  ASSERT_EQ(encoded.bytes.size(), 695U);
  const DecodedDepth decoded = decodeDepth(encoded);
  Hash hash;
  for (const float z : decoded.depth) {
    hash.add(z > 0.0F ? static_cast<std::uint32_t>(std::lround(z / kDepthUnit)) : 0U);
  }
  EXPECT_EQ(hash.value(), 12740166800506047621ULL);
  EXPECT_EQ(encodeDepth(decoded.depth.view(), encoded.camera, decoded.plane_fit).bytes,
            encoded.bytes);
}

}  // namespace
}  // namespace planecloud

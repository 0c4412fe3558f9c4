// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "planar_scene.h"
#include "planecloud_slam/plane_fit/plane_cloud_codec.h"

/// `fixtures/plane_cloud_compact_v1.bin` is a COMPACT stream of version 1 as it was first released
/// (the noisy corridor of planar_scene.h, distorted camera). Streams recorded then must decode to
/// the same bits for ever, on every machine: never write the file anew, add a version.
namespace planecloud {
namespace {

EncodedPlaneCloud readFixture() {
  const std::filesystem::path path =
      std::filesystem::path(__FILE__).parent_path() / "fixtures/plane_cloud_compact_v1.bin";
  std::ifstream file(path, std::ios::binary);
  EncodedPlaneCloud encoded;
  encoded.camera = distortedTestCamera();
  encoded.plane_count = 490;
  encoded.bytes.assign(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  return encoded;
}

/// FNV-1a over the little-endian words of all tiles: x y width height, alpha beta gamma.
std::uint64_t hashTiles(const PlaneCloud& cloud) {
  std::uint64_t hash = 1469598103934665603ULL;
  const auto add = [&hash](std::uint32_t word) {
    for (int i = 0; i < 4; ++i) {
      hash ^= (word >> (8 * i)) & 255U;
      hash *= 1099511628211ULL;
    }
  };
  for (const PlanarTile& tile : cloud.tiles) {
    for (const int side : {tile.rect.x, tile.rect.y, tile.rect.width, tile.rect.height}) {
      add(static_cast<std::uint32_t>(side));
    }
    for (int i = 0; i < 3; ++i) {
      std::uint32_t bits = 0;
      const float coefficient = tile.inverse_depth(i);
      std::memcpy(&bits, &coefficient, sizeof(bits));
      add(bits);
    }
  }
  return hash;
}

TEST(PlaneCloudFixture, OfVersion1DecodesToTheSameBits) {
  const EncodedPlaneCloud encoded = readFixture();
  ASSERT_EQ(encoded.bytes.size(), 556U);
  const PlaneCloud cloud = decode(encoded);
  ASSERT_EQ(cloud.tiles.size(), 490U);
  EXPECT_EQ(cloud.layout, (QuadtreeLayout{64, 64, 4}));
  const PlanarTile& tile = cloud.tiles[245];
  EXPECT_EQ(tile.rect, (TileRect{416, 448, 16, 16}));
  EXPECT_EQ(tile.inverse_depth, Eigen::Vector3f(0.0F, 0x1.424bc6p+0F, -0x1.b1b6f6p-9F));
  EXPECT_EQ(hashTiles(cloud), 6326323532809696673ULL);
}

TEST(PlaneCloudFixture, OfVersion1IsWhatTheEncoderWrites) {
  const EncodedPlaneCloud encoded = readFixture();
  CodecOptions options;
  options.quantisation_step = 1e-3;
  EXPECT_EQ(encode(decode(encoded), options).bytes, encoded.bytes);
}

}  // namespace
}  // namespace planecloud

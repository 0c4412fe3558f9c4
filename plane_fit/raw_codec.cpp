// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/plane_fit/raw_codec.h"

#include <algorithm>
#include <cmath>

#include "planecloud_slam/plane_fit/byte_stream.h"
#include "planecloud_slam/plane_fit/coding_order.h"
#include "planecloud_slam/plane_fit/stream_header.h"
#include "planecloud_slam/plane_fit/tile_merger.h"

namespace planecloud {
namespace {

constexpr std::uint32_t kRawVersion = 0x11;
constexpr std::size_t kHeaderSize = 8;
constexpr std::size_t kPlaneSize = 32;

int wholeNumber(float value) {
  if (!(value >= 0.0F && value <= 8192.0F) || value != std::floor(value)) {
    throw PlaneCloudDecodeError("plane cloud: impossible tile");
  }
  return static_cast<int>(value);
}

void writePlane(const PlanarTile& tile, ByteWriter& writer) {
  const Eigen::Vector4d plane = tile.plane();
  if (!plane.allFinite()) throw std::invalid_argument("plane cloud: a plane is not finite");
  for (int i = 0; i < 4; ++i) writer.f32(static_cast<float>(plane(i)));
  for (const int side : {tile.rect.x, tile.rect.y, tile.rect.width, tile.rect.height}) {
    writer.f32(static_cast<float>(side));
  }
}

PlanarTile readPlane(ByteReader& reader) {
  Eigen::Vector4d plane;
  for (int i = 0; i < 4; ++i) plane(i) = reader.f32();
  const double length = plane.head<3>().norm();
  if (!plane.allFinite() || !(plane(3) > 0.0) || !(std::abs(length - 1.0) < 1e-3)) {
    throw PlaneCloudDecodeError("plane cloud: impossible plane coefficients");
  }
  PlanarTile tile;
  tile.inverse_depth = (-plane.head<3>() / plane(3)).cast<float>();
  tile.rect.x = wholeNumber(reader.f32());
  tile.rect.y = wholeNumber(reader.f32());
  tile.rect.width = wholeNumber(reader.f32());
  tile.rect.height = wholeNumber(reader.f32());
  if (!tile.inverse_depth.allFinite()) {
    throw PlaneCloudDecodeError("plane cloud: impossible plane coefficients");
  }
  return tile;
}

}  // namespace

EncodedPlaneCloud encodeRaw(const PlaneCloud& cloud, const CodecOptions& options) {
  cloud.camera.check();
  const QuadtreeGrid grid(cloud.layout, cloud.camera.width, cloud.camera.height);
  std::vector<TileNode> tiles = inCodingOrder(grid, cloud.tiles);
  EncodedPlaneCloud encoded;
  encoded.camera = cloud.camera;
  encoded.encoding = PlaneCloudEncoding::kRaw;
  encoded.statistics = cloud.statistics;
  if (options.byte_budget > 0) {
    const auto budget = static_cast<std::size_t>(options.byte_budget);
    const std::size_t room = (budget - kHeaderSize) / kPlaneSize;
    if (tiles.size() > room) {
      const TileMerger merger(grid, cloud.camera, tiles,
                              std::vector<double>(tiles.size(), 8.0 * kPlaneSize));
      const TileMerger::Version version = merger.largest(
          [&](const TileMerger::Version& candidate) { return candidate.tiles.size() <= room; });
      tiles = inCodingOrder(grid, version.tiles);
      encoded.statistics = merger.reduce(cloud.statistics, version);
    }
  }
  encoded.plane_count = static_cast<std::uint32_t>(tiles.size());
  encoded.bytes.reserve(kHeaderSize + kPlaneSize * tiles.size());
  ByteWriter writer(encoded.bytes);
  writeStreamHeader(kRawVersion, cloud.layout, writer);
  writer.u32(encoded.plane_count);
  for (const TileNode& tile : tiles) writePlane(tile.tile, writer);
  return encoded;
}

PlaneCloud decodeRaw(const EncodedPlaneCloud& encoded) {
  ByteReader reader(encoded.bytes.data(), encoded.bytes.size());
  PlaneCloud cloud = readStreamHeader(encoded, kRawVersion, "RAW", reader);
  const std::uint32_t count = reader.u32();
  if (count != encoded.plane_count || reader.left() != std::uint64_t{count} * kPlaneSize) {
    throw PlaneCloudDecodeError("plane cloud: the number of planes does not match the stream");
  }
  const QuadtreeGrid grid(cloud.layout, cloud.camera.width, cloud.camera.height);
  cloud.tiles.reserve(count);
  for (std::uint32_t i = 0; i < count; ++i) cloud.tiles.push_back(readPlane(reader));
  const std::vector<TileNode> ordered = inCodingOrder(grid, cloud.tiles);
  std::transform(ordered.begin(), ordered.end(), cloud.tiles.begin(),
                 [](const TileNode& tile) { return tile.tile; });
  return cloud;
}

}  // namespace planecloud

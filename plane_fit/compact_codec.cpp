// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/plane_fit/compact_codec.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "planecloud_slam/plane_fit/byte_stream.h"
#include "planecloud_slam/plane_fit/coding_order.h"
#include "planecloud_slam/plane_fit/quadtree_walk.h"

namespace planecloud {
namespace {

constexpr std::uint32_t kCompactVersion = 0x21;
std::uint16_t crc16(const CameraIntrinsics& camera, const std::uint8_t* bytes, std::size_t size) {
  std::uint32_t crc = 0xFFFF;
  const auto add = [&crc](std::uint32_t byte) {
    crc ^= byte << 8;
    for (int bit = 0; bit < 8; ++bit) crc = (crc << 1) ^ ((crc & 0x8000U) != 0 ? 0x1021U : 0U);
    crc &= 0xFFFFU;
  };
  for (const int side : {camera.width, camera.height}) {
    add(static_cast<std::uint32_t>(side) & 255U);
    add(static_cast<std::uint32_t>(side) >> 8);
  }
  for (std::size_t i = 0; i < size; ++i) add(bytes[i]);
  return static_cast<std::uint16_t>(crc);
}

/// A stream of the first tiles and an upper bound of its length after each of them.
struct Draft {
  std::vector<std::uint8_t> bytes;
  std::vector<std::size_t> sizes;
};

Draft encodeTiles(const QuadtreeGrid& grid, const CameraIntrinsics& camera, int step,
                  const std::vector<CodedTile>& tiles) {
  Draft draft;
  ByteWriter writer(draft.bytes);
  writer.u8(kCompactVersion);
  writer.u8(grid.layout().initial_width);
  writer.u8(grid.layout().initial_height);
  writer.u8(grid.layout().min_tile);
  writer.u16(static_cast<std::uint32_t>(step));
  writer.varint(static_cast<std::uint32_t>(tiles.size()));
  const std::size_t header = draft.bytes.size();
  RangeEncoder coder(draft.bytes);
  const TileQuantiser quantiser(camera, grid, step);
  draft.sizes.reserve(tiles.size());
  walkQuadtrees(grid, quantiser, tiles.size(), coder, CodingPlan(grid, tiles),
                [&](const CodedTile&) {
                  draft.sizes.push_back(header + coder.bytesSoFar() + sizeof(std::uint16_t));
                });
  coder.finish();
  writer.u16(crc16(camera, draft.bytes.data(), draft.bytes.size()));
  return draft;
}

std::vector<CodedTile> quantiseTiles(const PlaneCloud& cloud, const QuadtreeGrid& grid, int step) {
  const TileQuantiser quantiser(cloud.camera, grid, step);
  std::vector<CodedTile> coded;
  coded.reserve(cloud.tiles.size());
  for (const TileNode& tile : inCodingOrder(grid, cloud.tiles)) {
    const std::optional<QuantisedPlane> plane = quantiser.quantise(tile.tile, tile.node.level);
    if (!plane) {
      throw std::invalid_argument(
          "plane cloud: the plane of the tile at (" + std::to_string(tile.tile.rect.x) + ", " +
          std::to_string(tile.tile.rect.y) + ") does not lie in front of the camera");
    }
    coded.push_back({tile.node, *plane});
  }
  return coded;
}

/// Leaves out the last tiles until the stream fits.
Draft encodeWithin(std::size_t budget, const QuadtreeGrid& grid, const CameraIntrinsics& camera,
                   int step, std::vector<CodedTile>& tiles) {
  Draft draft = encodeTiles(grid, camera, step, tiles);
  while (draft.bytes.size() > budget && !tiles.empty()) {
    // Tiles left out change the split flags of their ancestors, so the estimate may be a few
    // bytes off; each round leaves out at least one more.
    const auto fitting = std::upper_bound(draft.sizes.begin(), draft.sizes.end(), budget);
    const auto count = static_cast<std::size_t>(fitting - draft.sizes.begin());
    tiles.resize(std::min(count, tiles.size() - 1));
    draft = encodeTiles(grid, camera, step, tiles);
  }
  return draft;
}

double areaOf(const QuadtreeGrid& grid, const std::vector<CodedTile>& tiles) {
  double area = 0.0;
  for (const CodedTile& tile : tiles) area += grid.rect(tile.node).area();
  return area;
}

}  // namespace

EncodedPlaneCloud encodeCompact(const PlaneCloud& cloud, const CodecOptions& options) {
  cloud.camera.check();
  const QuadtreeGrid grid(cloud.layout, cloud.camera.width, cloud.camera.height);
  const auto step =
      static_cast<int>(std::lround(options.quantisation_step / TileQuantiser::kStepUnit));
  std::vector<CodedTile> tiles = quantiseTiles(cloud, grid, step);
  const double area = areaOf(grid, tiles);
  EncodedPlaneCloud encoded;
  encoded.camera = cloud.camera;
  encoded.encoding = PlaneCloudEncoding::kCompact;
  encoded.statistics = cloud.statistics;
  if (options.byte_budget > 0) {
    const auto budget = static_cast<std::size_t>(options.byte_budget);
    encoded.bytes = encodeWithin(budget, grid, cloud.camera, step, tiles).bytes;
  } else {
    encoded.bytes = encodeTiles(grid, cloud.camera, step, tiles).bytes;
  }
  encoded.plane_count = static_cast<std::uint32_t>(tiles.size());
  if (tiles.size() < cloud.tiles.size()) {
    encoded.statistics.stopped_by_bytes = true;
    encoded.statistics.coverage *= areaOf(grid, tiles) / area;
  }
  return encoded;
}

PlaneCloud decodeCompact(const EncodedPlaneCloud& encoded) {
  const std::vector<std::uint8_t>& bytes = encoded.bytes;
  ByteReader reader(bytes.data(), bytes.size());
  if (reader.u8() != kCompactVersion) {
    throw PlaneCloudDecodeError("plane cloud: COMPACT version " + std::to_string(bytes[0]) +
                                " is unknown here: update the receiver");
  }
  PlaneCloud cloud;
  cloud.camera = encoded.camera;
  cloud.statistics = encoded.statistics;
  cloud.layout.initial_width = static_cast<int>(reader.u8());
  cloud.layout.initial_height = static_cast<int>(reader.u8());
  cloud.layout.min_tile = static_cast<int>(reader.u8());
  const auto step = static_cast<int>(reader.u16());
  const std::uint32_t count = reader.varint();
  if (reader.left() < sizeof(std::uint16_t) ||
      crc16(encoded.camera, bytes.data(), bytes.size() - 2) !=
          (bytes[bytes.size() - 2] | (bytes[bytes.size() - 1] << 8))) {
    throw PlaneCloudDecodeError("plane cloud: wrong checksum, the stream is truncated or corrupt");
  }
  if (step < TileQuantiser::kMinStep || step > TileQuantiser::kMaxStep) {
    throw PlaneCloudDecodeError("plane cloud: impossible quantisation step");
  }
  const QuadtreeGrid grid(cloud.layout, cloud.camera.width, cloud.camera.height);
  const std::int64_t cells = std::int64_t{grid.cellColumns()} * grid.cellRows();
  if (count != encoded.plane_count || count > cells) {
    throw PlaneCloudDecodeError("plane cloud: impossible number of planes");
  }
  RangeDecoder coder(reader.rest(), reader.left() - sizeof(std::uint16_t));
  const TileQuantiser quantiser(cloud.camera, grid, step);
  cloud.tiles.reserve(count);
  const auto decodeTile = [&](const CodedTile& tile) {
    const auto plane = quantiser.dequantise(tile.plane, grid.rect(tile.node), tile.node.level);
    if (!plane) throw PlaneCloudDecodeError("plane cloud: impossible plane coefficients");
    cloud.tiles.push_back(*plane);
  };
  if (walkQuadtrees(grid, quantiser, count, coder, NoPlan{}, decodeTile) != count) {
    throw PlaneCloudDecodeError("plane cloud: fewer tiles than announced");
  }
  if (!coder.atEnd()) throw PlaneCloudDecodeError("plane cloud: bytes left over");
  return cloud;
}

}  // namespace planecloud

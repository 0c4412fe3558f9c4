// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/plane_fit/compact_codec.h"

#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>

#include "planecloud_slam/plane_fit/byte_stream.h"
#include "planecloud_slam/plane_fit/checksum.h"
#include "planecloud_slam/plane_fit/coding_order.h"
#include "planecloud_slam/plane_fit/quadtree_walk.h"
#include "planecloud_slam/plane_fit/stream_header.h"
#include "planecloud_slam/plane_fit/tile_merger.h"
#include "planecloud_slam/plane_fit/validity_mask.h"

namespace planecloud {
namespace {

constexpr std::uint32_t kCompactVersion = 0x22;
constexpr std::uint32_t kMaskBit = 0x8000;

/// What a cloud becomes on the wire.
class CompactEncoder {
 public:
  CompactEncoder(const PlaneCloud& cloud, const QuadtreeGrid& grid, const CodecOptions& options)
      : cloud_(cloud),
        grid_(grid),
        step_(static_cast<int>(std::lround(options.quantisation_step / TileQuantiser::kStepUnit))),
        with_mask_(options.mask),
        quantiser_(cloud.camera, grid, step_) {}

  /// `tile_bits`: what each tile took, in coding order.
  [[nodiscard]] std::vector<std::uint8_t> encode(const std::vector<TileNode>& tiles,
                                                 std::vector<double>* tile_bits = nullptr) const {
    const std::vector<CodedTile> coded = quantise(tiles);
    std::vector<std::uint8_t> bytes;
    ByteWriter writer(bytes);
    writeStreamHeader(kCompactVersion, grid_.layout(), writer);
    writer.u16(static_cast<std::uint32_t>(step_) | (with_mask_ ? kMaskBit : 0U));
    writer.varint(static_cast<std::uint32_t>(coded.size()));
    RangeEncoder coder(bytes);
    walkQuadtrees(grid_, quantiser_, coded.size(), coder, CodingPlan(grid_, coded),
                  [&](const CodedTile&) {
                    if (tile_bits != nullptr) tile_bits->push_back(coder.bitsSoFar());
                  });
    if (with_mask_) encodeMask(coder, cloud_.mask, rectsOf(tiles));
    coder.finish();
    writer.u16(streamChecksum(cloud_.camera, bytes.data(), bytes.size()));
    return bytes;
  }

 private:
  static std::vector<TileRect> rectsOf(const std::vector<TileNode>& tiles) {
    std::vector<TileRect> rects;
    rects.reserve(tiles.size());
    for (const TileNode& tile : tiles) rects.push_back(tile.tile.rect);
    return rects;
  }

  [[nodiscard]] std::vector<CodedTile> quantise(const std::vector<TileNode>& tiles) const {
    std::vector<CodedTile> coded;
    coded.reserve(tiles.size());
    for (const TileNode& tile : tiles) {
      const std::optional<QuantisedPlane> plane = quantiser_.quantise(tile.tile, tile.node.level);
      if (!plane) {
        throw std::invalid_argument(
            "plane cloud: the plane of the tile at (" + std::to_string(tile.tile.rect.x) + ", " +
            std::to_string(tile.tile.rect.y) + ") does not lie in front of the camera");
      }
      coded.push_back({tile.node, *plane});
    }
    return coded;
  }

  const PlaneCloud& cloud_;
  const QuadtreeGrid& grid_;
  int step_;
  bool with_mask_;
  TileQuantiser quantiser_;
};

void checkMask(const PlaneCloud& cloud) {
  if (cloud.mask.width() == cloud.camera.width && cloud.mask.height() == cloud.camera.height) {
    return;
  }
  throw std::invalid_argument("codec/mask: the plane cloud has no mask of its image's size");
}

}  // namespace

EncodedPlaneCloud encodeCompact(const PlaneCloud& cloud, const CodecOptions& options) {
  cloud.camera.check();
  if (options.mask) checkMask(cloud);
  const QuadtreeGrid grid(cloud.layout, cloud.camera.width, cloud.camera.height);
  const CompactEncoder encoder(cloud, grid, options);
  std::vector<TileNode> tiles = inCodingOrder(grid, cloud.tiles);
  EncodedPlaneCloud encoded;
  encoded.camera = cloud.camera;
  encoded.encoding = PlaneCloudEncoding::kCompact;
  encoded.statistics = cloud.statistics;
  encoded.bytes = encoder.encode(tiles);
  const auto budget = static_cast<std::size_t>(options.byte_budget);
  if (budget > 0 && encoded.bytes.size() > budget) {
    std::vector<double> bits;
    (void)encoder.encode(tiles, &bits);
    std::adjacent_difference(bits.begin(), bits.end(), bits.begin());
    const TileMerger merger(grid, cloud.camera, tiles, bits);
    const TileMerger::Version version = merger.largest([&](const TileMerger::Version& candidate) {
      return encoder.encode(inCodingOrder(grid, candidate.tiles)).size() <= budget;
    });
    tiles = inCodingOrder(grid, version.tiles);
    encoded.bytes = encoder.encode(tiles);
    encoded.statistics = merger.reduce(cloud.statistics, version);
  }
  encoded.plane_count = static_cast<std::uint32_t>(tiles.size());
  return encoded;
}

PlaneCloud decodeCompact(const EncodedPlaneCloud& encoded) {
  const std::vector<std::uint8_t>& bytes = encoded.bytes;
  ByteReader reader(bytes.data(), bytes.size());
  PlaneCloud cloud = readStreamHeader(encoded, kCompactVersion, "COMPACT", reader);
  const std::uint32_t step_and_mask = reader.u16();
  const auto step = static_cast<int>(step_and_mask & ~kMaskBit);
  const std::uint32_t count = reader.varint();
  requireChecksum(encoded.camera, bytes);
  if (reader.left() < sizeof(std::uint16_t)) {
    throw PlaneCloudDecodeError("plane cloud: the stream is truncated");
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
    // In the clipped corner several nodes have the same pixels: the coarsest is meant.
    if (!(grid.find(grid.rect(tile.node)) == tile.node)) {
      throw PlaneCloudDecodeError("plane cloud: impossible tile");
    }
    const auto plane = quantiser.dequantise(tile.plane, grid.rect(tile.node), tile.node.level);
    if (!plane) throw PlaneCloudDecodeError("plane cloud: impossible plane coefficients");
    cloud.tiles.push_back(*plane);
  };
  if (walkQuadtrees(grid, quantiser, count, coder, NoPlan{}, decodeTile) != count) {
    throw PlaneCloudDecodeError("plane cloud: fewer tiles than announced");
  }
  if ((step_and_mask & kMaskBit) != 0) {
    std::vector<TileRect> rects;
    rects.reserve(count);
    for (const PlanarTile& tile : cloud.tiles) rects.push_back(tile.rect);
    cloud.mask = decodeMask(coder, cloud.camera, rects);
  }
  if (!coder.atEnd()) throw PlaneCloudDecodeError("plane cloud: bytes left over");
  return cloud;
}

}  // namespace planecloud

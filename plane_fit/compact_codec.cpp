// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/plane_fit/compact_codec.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "planecloud_slam/plane_fit/byte_stream.h"
#include "planecloud_slam/plane_fit/coding_order.h"
#include "planecloud_slam/plane_fit/integer_model.h"
#include "planecloud_slam/plane_fit/range_coder.h"
#include "planecloud_slam/plane_fit/tile_predictor.h"

namespace planecloud_slam {
namespace {

constexpr std::uint32_t kVersion = 0x21;
constexpr std::size_t kMaxLevels = 8;
constexpr std::size_t kSpreadClasses = 10;
constexpr std::size_t kSlopeClasses = 8;

/// A node's plane in integers; the walk's input when encoding, its result when decoding.
struct CodedTile {
  QuadtreeNode node;
  QuantisedPlane plane;
};

/// Bit length, at most `limit`.
std::size_t magnitudeClass(std::int32_t value, std::size_t limit) {
  std::size_t bits = 0;
  for (auto rest = static_cast<std::uint32_t>(std::abs(value)); rest != 0; rest >>= 1) ++bits;
  return std::min(bits, limit);
}

/// Everything that is learnt while a stream is coded. Both directions share it.
struct Models {
  std::array<std::array<AdaptiveBit, 16>, kMaxLevels> leaf;
  std::array<std::array<AdaptiveBit, 16>, kMaxLevels> split;
  std::array<std::array<IntegerModel, kSpreadClasses + 1>, 2> center;
  std::array<IntegerModel, kSlopeClasses + 1> right;
  std::array<IntegerModel, kSlopeClasses + 1> down;
};

/// Codes one plane less its prediction, in steps of its level.
class PlaneModel {
 public:
  PlaneModel(const QuadtreeGrid& grid, const TileQuantiser& quantiser)
      : grid_(grid), quantiser_(quantiser), predictor_(grid) {}

  template <typename Coder>
  bool codeLeaf(Coder& coder, const QuadtreeNode& node, bool leaf) {
    return coder.code(leaf, models_.leaf[levelClass(node)][predictor_.coveredSides(node)]);
  }
  template <typename Coder>
  bool codeSplit(Coder& coder, const QuadtreeNode& node, bool split) {
    return coder.code(split, models_.split[levelClass(node)][predictor_.coveredSides(node)]);
  }

  template <typename Coder>
  QuantisedPlane codePlane(Coder& coder, const QuadtreeNode& node, QuantisedPlane plane) {
    const int bits = quantiser_.stepBits(node.level);
    const TilePredictor::Candidates candidates = predictor_.candidates(node);
    const std::int32_t spread = predictor_.spread(candidates);
    const std::size_t spread_class =
        spread < 0 ? kSpreadClasses : magnitudeClass(spread >> bits, kSpreadClasses - 1);
    IntegerModel& center_model = models_.center[bits == TileQuantiser::kUnitBits][spread_class];
    std::int32_t residual = 0;
    plane.center = codeInteger(coder, center_model, predictor_.predictCenter(candidates),
                               plane.center, bits, residual);
    const QuantisedPlane slopes = predictor_.predictSlopes(candidates, plane.center);
    const std::size_t center_class =
        candidates.count == 0
            ? kSlopeClasses
            : magnitudeClass((slopes.center - plane.center) >> bits, kSlopeClasses - 1);
    plane.right = codeInteger(coder, models_.right[center_class], slopes.right, plane.right,
                              bits + 1, residual);
    const std::size_t right_class =
        candidates.count == 0 ? kSlopeClasses : magnitudeClass(residual, kSlopeClasses - 1);
    plane.down =
        codeInteger(coder, models_.down[right_class], slopes.down, plane.down, bits + 1, residual);
    predictor_.place(node, plane);
    return plane;
  }

 private:
  [[nodiscard]] std::size_t levelClass(const QuadtreeNode& node) const {
    return static_cast<std::size_t>(grid_.levels() - 1 - node.level);
  }

  /// Codes `value`, a multiple of 2^bits, as its distance in steps from the rounded prediction.
  template <typename Coder>
  static std::int32_t codeInteger(Coder& coder, IntegerModel& model, std::int32_t prediction,
                                  std::int32_t value, int bits, std::int32_t& residual) {
    const std::int32_t step = 1 << bits;
    const std::int32_t half = step / 2;
    const std::int32_t predicted_steps = (prediction + (prediction < 0 ? -half : half)) / step;
    residual = model.code(coder, value / step - predicted_steps);
    return (predicted_steps + residual) * step;
  }

  const QuadtreeGrid& grid_;
  const TileQuantiser& quantiser_;
  TilePredictor predictor_;
  Models models_;
};

/// What the encoder knows beforehand of every node.
class CodingPlan {
 public:
  CodingPlan(const QuadtreeGrid& grid, const std::vector<CodedTile>& tiles) : tiles_(tiles) {
    for (int level = 0; level < grid.levels(); ++level) {
      columns_.push_back(static_cast<std::size_t>(grid.columns(level)));
      const std::size_t nodes = columns_.back() * static_cast<std::size_t>(grid.rows(level));
      is_ancestor_.emplace_back(nodes, std::uint8_t{0});
    }
    for (const CodedTile& tile : tiles) {
      QuadtreeNode node = tile.node;
      while (node.level > 0) {
        node = {node.level - 1, node.column / 2, node.row / 2};
        is_ancestor_[static_cast<std::size_t>(node.level)][index(node)] = 1;
      }
    }
  }
  /// Nodes are asked in coding order, so only the next tile can be it.
  [[nodiscard]] bool isLeaf(const QuadtreeNode& node, std::size_t next) const {
    return tiles_[next].node == node;
  }
  [[nodiscard]] bool isSplit(const QuadtreeNode& node) const {
    return is_ancestor_[static_cast<std::size_t>(node.level)][index(node)] != 0;
  }
  [[nodiscard]] const QuantisedPlane& plane(std::size_t next) const { return tiles_[next].plane; }

 private:
  [[nodiscard]] std::size_t index(const QuadtreeNode& node) const {
    return static_cast<std::size_t>(node.row) * columns_[static_cast<std::size_t>(node.level)] +
           static_cast<std::size_t>(node.column);
  }
  const std::vector<CodedTile>& tiles_;
  std::vector<std::size_t> columns_;
  std::vector<std::vector<std::uint8_t>> is_ancestor_;
};

/// The decoder's answer to every question: whatever the stream says.
struct NoPlan {
  [[nodiscard]] static bool isLeaf(const QuadtreeNode& /*node*/, std::size_t /*next*/) {
    return false;
  }
  [[nodiscard]] static bool isSplit(const QuadtreeNode& /*node*/) { return false; }
  [[nodiscard]] static QuantisedPlane plane(std::size_t /*next*/) { return {}; }
};

/// Walks the quadtrees breadth first until `count` tiles are coded and hands each to `visit`.
/// Returns how many it found.
template <typename Coder, typename Plan, typename Visit>
std::size_t walk(const QuadtreeGrid& grid, const TileQuantiser& quantiser, std::size_t count,
                 Coder& coder, const Plan& plan, Visit&& visit) {
  PlaneModel model(grid, quantiser);
  std::vector<QuadtreeNode> queue;
  for (int row = 0; row < grid.rows(0); ++row) {
    for (int column = 0; column < grid.columns(0); ++column) queue.push_back({0, column, row});
  }
  std::size_t coded = 0;
  std::vector<QuadtreeNode> next;
  for (int level = 0; level < grid.levels(); ++level) {
    next.clear();
    for (const QuadtreeNode& node : queue) {
      if (coded == count) return coded;
      if (grid.rect(node).area() == 0) continue;
      if (model.codeLeaf(coder, node, plan.isLeaf(node, coded))) {
        visit(CodedTile{node, model.codePlane(coder, node, plan.plane(coded))});
        ++coded;
      } else if (level + 1 < grid.levels() && model.codeSplit(coder, node, plan.isSplit(node))) {
        const int column = 2 * node.column;
        const int row = 2 * node.row;
        next.insert(next.end(), {{level + 1, column, row},
                                 {level + 1, column + 1, row},
                                 {level + 1, column, row + 1},
                                 {level + 1, column + 1, row + 1}});
      }
    }
    queue.swap(next);
  }
  return coded;
}

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
  writer.u8(kVersion);
  writer.u8(grid.layout().initial_width);
  writer.u8(grid.layout().initial_height);
  writer.u8(grid.layout().min_tile);
  writer.u16(static_cast<std::uint32_t>(step));
  writer.varint(static_cast<std::uint32_t>(tiles.size()));
  const std::size_t header = draft.bytes.size();
  RangeEncoder coder(draft.bytes);
  const TileQuantiser quantiser(camera, grid, step);
  draft.sizes.reserve(tiles.size());
  walk(grid, quantiser, tiles.size(), coder, CodingPlan(grid, tiles), [&](const CodedTile&) {
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
  if (reader.u8() != kVersion) {
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
  if (walk(grid, quantiser, count, coder, NoPlan{}, decodeTile) != count) {
    throw PlaneCloudDecodeError("plane cloud: fewer tiles than announced");
  }
  if (!coder.atEnd()) throw PlaneCloudDecodeError("plane cloud: bytes left over");
  return cloud;
}

}  // namespace planecloud_slam

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/plane_fit/depth_codec.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "planecloud_slam/plane_fit/byte_stream.h"
#include "planecloud_slam/plane_fit/checksum.h"
#include "planecloud_slam/plane_fit/depth_model.h"
#include "planecloud_slam/plane_fit/depth_traits.h"
#include "planecloud_slam/plane_fit/quadtree_fitter.h"

namespace planecloud {
namespace {

constexpr std::uint32_t kLosslessVersion = 0x31;
constexpr int kMaxCount = 65535;
constexpr double kCountsPerMetre = 5000.0;

int toCount(float depth) {
  if (!hasDepth(depth)) return 0;
  const double counts = std::round(static_cast<double>(depth) * kCountsPerMetre);
  return counts > kMaxCount ? 0 : static_cast<int>(counts);
}

float toDepth(int count) {
  return static_cast<float>(static_cast<double>(count) / kCountsPerMetre);
}

/// The last rows of ranks with a margin, so that every pixel has neighbours.
class RankRows {
 public:
  explicit RankRows(int width)
      : stride_(static_cast<std::size_t>(width) + 3), ranks_(3 * stride_, 0) {}

  void next() {
    row_ = (row_ + 1) % 3;
    std::fill_n(at(0, 0) - 2, stride_, 0);
  }
  [[nodiscard]] DepthNeighbors around(int x) {
    return {at(0, x)[-1], at(1, x)[0], at(1, x)[-1], at(1, x)[1], at(0, x)[-2], at(2, x)[0]};
  }
  void set(int x, std::int32_t rank) { *at(0, x) = rank; }

 private:
  /// Column `x` of the row `above` rows over the current one.
  std::int32_t* at(std::size_t above, int x) {
    return ranks_.data() + (row_ + 3 - above) % 3 * stride_ + 2 + x;
  }
  std::size_t stride_;
  std::vector<std::int32_t> ranks_;
  std::size_t row_ = 0;
};

/// Codes the image row by row: `rankOf(x, y)` is asked (a decoder's answer is ignored) and
/// `take(x, y, rank)` told.
template <typename Coder, typename RankOf, typename Take>
void codePixels(Coder& coder, const CameraIntrinsics& camera, RankOf&& rankOf, Take&& take) {
  const auto model = std::make_unique<DepthModel>();
  RankRows rows(camera.width);
  for (int y = 0; y < camera.height; ++y) {
    rows.next();
    for (int x = 0; x < camera.width; ++x) {
      const std::int32_t rank = model->codePixel(coder, rows.around(x), rankOf(x, y));
      rows.set(x, rank);
      take(x, y, rank);
    }
  }
}

/// The depths that occur [kDepthUnit], ascending.
std::vector<int> differentCounts(ImageView<float> depth) {
  std::vector<std::uint8_t> occurs(kMaxCount + 1, 0);
  for (int y = 0; y < depth.height(); ++y) {
    for (int x = 0; x < depth.width(); ++x) {
      occurs[static_cast<std::size_t>(toCount(depth(x, y)))] = 1;
    }
  }
  std::vector<int> counts;
  for (int count = 1; count <= kMaxCount; ++count) {
    if (occurs[static_cast<std::size_t>(count)] != 0) counts.push_back(count);
  }
  return counts;
}

void writeOptions(const QuadtreeFitterOptions& options, ByteWriter& writer) {
  writer.u8(options.initial_tile_width);
  writer.u8(options.initial_tile_height);
  writer.u8(options.min_tile);
  writer.u8(static_cast<int>(options.acceptance) | static_cast<int>(options.corner_check) << 2 |
            (options.along_ray_test ? 16 : 0));
  for (const double value :
       {options.tolerance, options.lambda, options.min_fill, options.planarity_factor}) {
    writer.f32(static_cast<float>(value));
  }
}

QuadtreeFitterOptions readOptions(ByteReader& reader) {
  QuadtreeFitterOptions options;
  options.initial_tile_width = static_cast<int>(reader.u8());
  options.initial_tile_height = static_cast<int>(reader.u8());
  options.min_tile = static_cast<int>(reader.u8());
  const std::uint32_t choices = reader.u8();
  if ((choices & 3U) == 3U || ((choices >> 2) & 3U) == 3U || choices > 31U) {
    throw PlaneCloudDecodeError("plane cloud: impossible fit options");
  }
  options.acceptance = static_cast<AcceptanceRule>(choices & 3U);
  options.corner_check = static_cast<CornerCheck>((choices >> 2) & 3U);
  options.along_ray_test = (choices & 16U) != 0;
  for (double* value :
       {&options.tolerance, &options.lambda, &options.min_fill, &options.planarity_factor}) {
    *value = static_cast<double>(reader.f32());
  }
  options.check();
  return options;
}

std::vector<int> decodeCounts(RangeDecoder& coder, std::uint32_t number) {
  IntegerModel gaps;
  std::vector<int> counts;
  counts.reserve(number);
  int count = 0;
  for (std::uint32_t i = 0; i < number; ++i) {
    const std::int32_t gap = gaps.code(coder, 0);
    if (gap < 1 || gap > kMaxCount - count) {
      throw PlaneCloudDecodeError("plane cloud: impossible depth");
    }
    count += gap;
    if (toCount(toDepth(count)) != count) {  // nearer than any depth can be
      throw PlaneCloudDecodeError("plane cloud: impossible depth");
    }
    counts.push_back(count);
  }
  return counts;
}

Image<float> decodePixels(RangeDecoder& coder, const CameraIntrinsics& camera,
                          const std::vector<int>& counts) {
  Image<float> depth(camera.width, camera.height, std::numeric_limits<float>::quiet_NaN());
  const auto most = static_cast<std::int32_t>(counts.size());
  const auto take = [&](int x, int y, std::int32_t rank) {
    if (rank > most) throw PlaneCloudDecodeError("plane cloud: impossible depth");
    if (rank > 0) depth(x, y) = toDepth(counts[static_cast<std::size_t>(rank) - 1]);
  };
  codePixels(
      coder, camera, [](int, int) { return 0; }, take);
  if (!coder.atEnd()) throw PlaneCloudDecodeError("plane cloud: bytes left over");
  return depth;
}

DecodedDepth decodeStream(const EncodedPlaneCloud& encoded) {
  encoded.camera.check();
  const std::vector<std::uint8_t>& bytes = encoded.bytes;
  ByteReader reader(bytes.data(), bytes.size());
  if (encoded.encoding != PlaneCloudEncoding::kLossless || reader.u8() != kLosslessVersion) {
    throw PlaneCloudDecodeError(
        "plane cloud: LOSSLESS version is unknown here: update the receiver");
  }
  DecodedDepth decoded;
  decoded.plane_fit = readOptions(reader);
  const std::uint32_t number = reader.varint();
  requireChecksum(encoded.camera, bytes);
  if (reader.left() < sizeof(std::uint16_t)) {
    throw PlaneCloudDecodeError("plane cloud: the stream is truncated");
  }
  if (encoded.plane_count != 0 || number > kMaxCount) {
    throw PlaneCloudDecodeError("plane cloud: impossible number of planes or depths");
  }
  RangeDecoder coder(reader.rest(), reader.left() - sizeof(std::uint16_t));
  decoded.depth = decodePixels(coder, encoded.camera, decodeCounts(coder, number));
  return decoded;
}

}  // namespace

EncodedPlaneCloud encodeDepth(ImageView<float> depth, const CameraIntrinsics& camera,
                              const QuadtreeFitterOptions& plane_fit) {
  camera.check();
  plane_fit.check();
  if (depth.width() != camera.width || depth.height() != camera.height) {
    throw std::invalid_argument("depth image and camera differ in size");
  }
  EncodedPlaneCloud encoded;
  encoded.camera = camera;
  encoded.encoding = PlaneCloudEncoding::kLossless;
  encoded.statistics.coverage = 1.0;
  ByteWriter writer(encoded.bytes);
  writer.u8(kLosslessVersion);
  writeOptions(plane_fit, writer);
  const std::vector<int> counts = differentCounts(depth);
  writer.varint(static_cast<std::uint32_t>(counts.size()));
  RangeEncoder coder(encoded.bytes);
  std::vector<std::int32_t> ranks(kMaxCount + 1, 0);
  IntegerModel gaps;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    gaps.code(coder, counts[i] - (i == 0 ? 0 : counts[i - 1]));
    ranks[static_cast<std::size_t>(counts[i])] = static_cast<std::int32_t>(i) + 1;
  }
  codePixels(
      coder, camera,
      [&](int x, int y) { return ranks[static_cast<std::size_t>(toCount(depth(x, y)))]; },
      [](int, int, std::int32_t) {});
  coder.finish();
  writer.u16(streamChecksum(camera, encoded.bytes.data(), encoded.bytes.size()));
  return encoded;
}

DecodedDepth decodeDepth(const EncodedPlaneCloud& encoded) {
  try {
    return decodeStream(encoded);
  } catch (const std::invalid_argument& error) {
    throw PlaneCloudDecodeError(std::string("plane cloud: ") + error.what());
  }
}

PlaneCloud fitDecodedDepth(const EncodedPlaneCloud& encoded) {
  const DecodedDepth decoded = decodeDepth(encoded);
  QuadtreeFitter fitter(std::make_shared<const Camera>(encoded.camera), decoded.plane_fit);
  return fitter.fit(decoded.depth.view());
}

}  // namespace planecloud

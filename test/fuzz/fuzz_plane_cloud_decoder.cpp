// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "planecloud_slam/plane_fit/checksum.h"
#include "planecloud_slam/plane_fit/depth_codec.h"
#include "planecloud_slam/plane_fit/plane_cloud_codec.h"
#include "planecloud_slam/plane_fit/reconstruction.h"

/// A libFuzzer target for the decoders of all encodings. Whatever the bytes, they throw
/// PlaneCloudDecodeError or return what survives another round trip.
///
///     byte 0     encoding (bits 0-1), leave the checksum wrong (bit 2), lens distortion (bit 3),
///     no
///                round trip of depth, which takes most of the time (bit 4)
///     bytes 1-2  image width - 16, height - 16 [px], small so that executions are fast
///     bytes 3-4  number of planes beside the stream
///     ...        the stream
namespace planecloud {
namespace {

constexpr std::size_t kHeader = 5;

EncodedPlaneCloud readInput(const std::uint8_t* bytes, std::size_t size) {
  EncodedPlaneCloud encoded;
  encoded.encoding = static_cast<PlaneCloudEncoding>(bytes[0] & 3);
  CameraIntrinsics& camera = encoded.camera;
  camera.width = 16 + bytes[1] % 25;
  camera.height = 16 + bytes[2] % 25;
  camera.fx = camera.fy = 100.0;
  camera.cx = 0.5 * camera.width;
  camera.cy = 0.5 * camera.height;
  if ((bytes[0] & 8) != 0) camera.distortion = {0.2, -0.5, -0.005, 0.002, 0.3};
  encoded.plane_count = bytes[3] + 256U * bytes[4];
  encoded.bytes.assign(bytes + kHeader, bytes + size);
  const std::size_t stream = encoded.bytes.size();
  if ((bytes[0] & 4) == 0 && stream >= 2) {
    const std::uint16_t crc = streamChecksum(camera, encoded.bytes.data(), stream - 2);
    encoded.bytes[stream - 2] = static_cast<std::uint8_t>(crc & 255);
    encoded.bytes[stream - 1] = static_cast<std::uint8_t>(crc >> 8);
  }
  return encoded;
}

void require(bool claim) {
  if (!claim) std::abort();
}

bool sameDepth(const Image<float>& a, const Image<float>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](float x, float y) { return x == y || (std::isnan(x) && std::isnan(y)); });
}

void checkDepth(const EncodedPlaneCloud& encoded, bool round_trip) {
  const DecodedDepth decoded = decodeDepth(encoded);
  if (!round_trip) return;
  const EncodedPlaneCloud again =
      encodeDepth(decoded.depth.view(), encoded.camera, decoded.plane_fit);
  require(sameDepth(decodeDepth(again).depth, decoded.depth));
}

void checkPlanes(const EncodedPlaneCloud& encoded) {
  const PlaneCloud cloud = decode(encoded);
  require(cloud.tiles.size() == encoded.plane_count);
  CodecOptions options;
  options.encoding = encoded.encoding;
  if (encoded.encoding == PlaneCloudEncoding::kCompact) {
    const int step = (encoded.bytes[4] | (encoded.bytes[5] << 8)) & 0x7FFF;
    options.quantisation_step = 1e-5 * step;
    options.mask = !cloud.mask.empty();
    const PlaneCloud again = decode(encode(cloud, options));
    require(again.tiles.size() == cloud.tiles.size());
    for (std::size_t i = 0; i < cloud.tiles.size(); ++i) {
      require(again.tiles[i].rect == cloud.tiles[i].rect);
      require(again.tiles[i].inverse_depth == cloud.tiles[i].inverse_depth);
    }
    require(std::equal(again.mask.begin(), again.mask.end(), cloud.mask.begin(), cloud.mask.end()));
  }
  (void)reconstructPoints(cloud, Camera(cloud.camera), 8);
}

}  // namespace
}  // namespace planecloud

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  if (size < planecloud::kHeader) return 0;
  const planecloud::EncodedPlaneCloud encoded = planecloud::readInput(bytes, size);
  try {
    if (encoded.encoding == planecloud::PlaneCloudEncoding::kLossless) {
      planecloud::checkDepth(encoded, (bytes[0] & 16) == 0);
    } else {
      planecloud::checkPlanes(encoded);
    }
  } catch (const planecloud::PlaneCloudDecodeError&) {
  }
  return 0;
}

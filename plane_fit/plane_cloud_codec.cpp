// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/plane_fit/plane_cloud_codec.h"

#include "planecloud_slam/plane_fit/compact_codec.h"
#include "planecloud_slam/plane_fit/depth_codec.h"
#include "planecloud_slam/plane_fit/raw_codec.h"
#include "planecloud_slam/plane_fit/tile_quantiser.h"

namespace planecloud {

void CodecOptions::check() const {
  checkRange("codec/quantisation_step", quantisation_step,
             TileQuantiser::kMinStep * TileQuantiser::kStepUnit,
             TileQuantiser::kMaxStep * TileQuantiser::kStepUnit);
  if (byte_budget != 0) checkRange("codec/byte_budget", byte_budget, 64, 1 << 30);
}

EncodedPlaneCloud encode(const PlaneCloud& cloud, const CodecOptions& options) {
  options.check();
  switch (options.encoding) {
    case PlaneCloudEncoding::kRaw:
      return encodeRaw(cloud, options);
    case PlaneCloudEncoding::kCompact:
      return encodeCompact(cloud, options);
    case PlaneCloudEncoding::kLossless:
      break;
  }
  throw std::invalid_argument("LOSSLESS codes the depth image, not its planes: see encodeDepth");
}

PlaneCloud decode(const EncodedPlaneCloud& encoded) {
  try {
    encoded.camera.check();
    switch (encoded.encoding) {
      case PlaneCloudEncoding::kRaw:
        return decodeRaw(encoded);
      case PlaneCloudEncoding::kCompact:
        return decodeCompact(encoded);
      case PlaneCloudEncoding::kLossless:
        return fitDecodedDepth(encoded);
    }
  } catch (const std::invalid_argument& error) {
    throw PlaneCloudDecodeError(std::string("plane cloud: ") + error.what());
  }
  throw PlaneCloudDecodeError("plane cloud: encoding " +
                              std::to_string(static_cast<int>(encoded.encoding)) +
                              " is unknown here: update the receiver");
}

PlaneCloud quantise(const PlaneCloud& cloud, const CodecOptions& options) {
  CodecOptions unlimited = options;
  unlimited.byte_budget = 0;
  return decode(encode(cloud, unlimited));
}

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/plane_fit/fitted_depth.h"

#include "planecloud_slam/plane_fit/depth_codec.h"
#include "planecloud_slam/plane_fit/validity_mask.h"

namespace planecloud {

EncodedPlaneCloud encode(const FittedDepth& fitted, const CodecOptions& options) {
  options.check();
  CodecOptions planes = options;
  if (options.encoding == PlaneCloudEncoding::kLossless) {
    EncodedPlaneCloud encoded = encodeDepth(fitted.depth, fitted.cloud.camera, fitted.plane_fit);
    const auto budget = static_cast<std::size_t>(options.byte_budget);
    if (budget == 0 || encoded.bytes.size() <= budget) return encoded;
    planes.encoding = PlaneCloudEncoding::kCompact;
  }
  if (!planes.mask) return encode(fitted.cloud, planes);
  PlaneCloud masked = fitted.cloud;
  masked.mask = validityMask(fitted.depth);
  return encode(masked, planes);
}

}  // namespace planecloud

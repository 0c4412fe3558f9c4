// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "planecloud_slam/plane_fit/image_view.h"
#include "planecloud_slam/plane_fit/plane_cloud_codec.h"
#include "planecloud_slam/plane_fit/quadtree_fitter_options.h"

namespace planecloud {

/// Planes together with what they were fitted to, for encodings that need more than planes.
struct FittedDepth {
  PlaneCloud cloud;
  ImageView<float> depth;           ///< [m], height x width of the cloud's camera
  QuadtreeFitterOptions plane_fit;  ///< how `cloud` was fitted
};

/// Planes, with the mask of `depth` where that is wished, or the depth itself: LOSSLESS, which is
/// sent as COMPACT where it would exceed the byte budget. Throws as `encode` of a plane cloud does.
[[nodiscard]] EncodedPlaneCloud encode(const FittedDepth& fitted, const CodecOptions& options);

}  // namespace planecloud

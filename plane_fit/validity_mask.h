// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "planecloud_slam/plane_fit/image_view.h"
#include "planecloud_slam/plane_fit/plane_cloud.h"
#include "planecloud_slam/plane_fit/range_coder.h"

namespace planecloud {

/// 1 where `depth` [m] was measured, else 0: the mask of a `PlaneCloud`.
[[nodiscard]] Image<std::uint8_t> validityMask(ImageView<float> depth);

/// Codes which pixels of the tiles have depth; outside the tiles none has. Blocks of 8 x 8 pixels
/// are full, empty or mixed; only the pixels of mixed ones are coded, from what is known around
/// them. `mask` is width x height of the image.
void encodeMask(RangeEncoder& coder, const Image<std::uint8_t>& mask,
                const std::vector<TileRect>& tiles);
/// The inverse, exact on the pixels of the tiles and 0 elsewhere.
[[nodiscard]] Image<std::uint8_t> decodeMask(RangeDecoder& coder, const CameraIntrinsics& camera,
                                             const std::vector<TileRect>& tiles);

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "planecloud_slam/plane_fit/image_view.h"
#include "planecloud_slam/plane_fit/plane_cloud_codec.h"
#include "planecloud_slam/plane_fit/quadtree_fitter_options.h"

/// LOSSLESS keyframes: the depth image itself instead of planes, for research recordings and for
/// scenes where planes would cost more. The stream, version 1 (integers little-endian):
///
///     u8   0x31
///     u8   initial tile width, initial tile height, min tile [px]
///     u8   acceptance rule (bits 0-1), corner check (bits 2-3), along-ray test (bit 4)
///     f32  tolerance [m], lambda, minimal fill, planarity factor: how the sender would have fitted
///     uv   number of different depths (7 bits a byte, lowest first, high bit: more follow)
///     ...  range-coded: the depths, each less the one before it, then the pixels in rows
///     u16  CRC-16/CCITT of image width, height (u16 each) and all bytes before
namespace planecloud {

/// Depths are whole multiples of this [m]: exact for images in millimetres and for those of the TUM
/// benchmark.
inline constexpr double kDepthUnit = 2e-4;

/// Codes `depth` [m] (NaN, infinite or <= 0: none), rounded to `kDepthUnit`; more than 13.1 m is
/// taken for none. `plane_fit` travels along for the receiver that fits planes again.
/// Throws std::invalid_argument when size and camera differ or an option fails its check.
[[nodiscard]] EncodedPlaneCloud encodeDepth(ImageView<float> depth, const CameraIntrinsics& camera,
                                            const QuadtreeFitterOptions& plane_fit);

/// What a LOSSLESS stream holds.
struct DecodedDepth {
  Image<float> depth;               ///< [m], NaN: none
  QuadtreeFitterOptions plane_fit;  ///< of the sender, without its budgets
};
/// Never trusts the stream: throws PlaneCloudDecodeError, and allocates no more than the image size
/// implies.
[[nodiscard]] DecodedDepth decodeDepth(const EncodedPlaneCloud& encoded);

/// The planes that the sender's fitter would have found (up to the rounding of vector kernels).
/// Throws as above.
[[nodiscard]] PlaneCloud fitDecodedDepth(const EncodedPlaneCloud& encoded);

}  // namespace planecloud

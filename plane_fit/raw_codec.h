// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "planecloud_slam/plane_fit/plane_cloud_codec.h"

/// The RAW stream, version 1 (little-endian), what the paper sends:
///
///     u8   0x11
///     u8   initial tile width, initial tile height, min tile [px]
///     u32  number of planes
///     8 float32 a plane: a b c d [-, m] of the Hessian normal form, x y width height [px]
namespace planecloud {

/// Throws std::invalid_argument for tiles that cannot be coded.
[[nodiscard]] EncodedPlaneCloud encodeRaw(const PlaneCloud& cloud, const CodecOptions& options);
/// Throws PlaneCloudDecodeError.
[[nodiscard]] PlaneCloud decodeRaw(const EncodedPlaneCloud& encoded);

}  // namespace planecloud

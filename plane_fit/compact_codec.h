// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "planecloud_slam/plane_fit/plane_cloud_codec.h"

/// The COMPACT stream, version 2 (integers little-endian):
///
///     u8   0x22
///     u8   initial tile width, initial tile height, min tile [px]
///     u16  quantisation step [1e-5 1/m] (bits 0-12), mask (bit 15)
///     uv   number of planes (7 bits a byte, lowest first, high bit: more follow)
///     ...  range-coded: nodes breadth first, each "tile here", else "split"; after the former the
///          plane as three integers less their prediction; ends with the last plane; then the
///          mask, if there is one
///     u16  CRC-16/CCITT of image width, height (u16 each) and all bytes before
namespace planecloud {

/// Throws std::invalid_argument for tiles that cannot be coded.
[[nodiscard]] EncodedPlaneCloud encodeCompact(const PlaneCloud& cloud, const CodecOptions& options);
/// Throws PlaneCloudDecodeError.
[[nodiscard]] PlaneCloud decodeCompact(const EncodedPlaneCloud& encoded);

}  // namespace planecloud

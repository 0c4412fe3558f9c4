// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "planecloud_slam/plane_fit/camera.h"

namespace planecloud {

/// CRC-16/CCITT (polynomial 0x1021, start 0xFFFF) of image width, image height (u16 each,
/// little-endian) and the bytes of a stream: it ends with this.
[[nodiscard]] std::uint16_t streamChecksum(const CameraIntrinsics& camera,
                                           const std::uint8_t* bytes, std::size_t size);

/// Throws PlaneCloudDecodeError when `bytes` do not end with the checksum of what comes before.
void requireChecksum(const CameraIntrinsics& camera, const std::vector<std::uint8_t>& bytes);

}  // namespace planecloud

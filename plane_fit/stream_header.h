// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "planecloud_slam/plane_fit/byte_stream.h"
#include "planecloud_slam/plane_fit/plane_cloud.h"

namespace planecloud {

/// How a stream of planes begins, RAW or COMPACT: a byte of version, three of the layout.
void writeStreamHeader(std::uint32_t version, const QuadtreeLayout& layout, ByteWriter& writer);

/// The cloud `encoded` announces, without its tiles; `reader` stands behind the header then. Throws
/// PlaneCloudDecodeError for another version than `version` of the encoding `name`.
[[nodiscard]] PlaneCloud readStreamHeader(const EncodedPlaneCloud& encoded, std::uint32_t version,
                                          const char* name, ByteReader& reader);

}  // namespace planecloud

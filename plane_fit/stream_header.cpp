// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/plane_fit/stream_header.h"

#include <string>

namespace planecloud {

void writeStreamHeader(std::uint32_t version, const QuadtreeLayout& layout, ByteWriter& writer) {
  writer.u8(static_cast<int>(version));
  writer.u8(layout.initial_width);
  writer.u8(layout.initial_height);
  writer.u8(layout.min_tile);
}

PlaneCloud readStreamHeader(const EncodedPlaneCloud& encoded, std::uint32_t version,
                            const char* name, ByteReader& reader) {
  const std::uint32_t found = reader.u8();
  if (found != version) {
    throw PlaneCloudDecodeError("plane cloud: " + std::string(name) + " version " +
                                std::to_string(found) + " is unknown here: update the receiver");
  }
  PlaneCloud cloud;
  cloud.camera = encoded.camera;
  cloud.statistics = encoded.statistics;
  cloud.layout.initial_width = static_cast<int>(reader.u8());
  cloud.layout.initial_height = static_cast<int>(reader.u8());
  cloud.layout.min_tile = static_cast<int>(reader.u8());
  return cloud;
}

}  // namespace planecloud

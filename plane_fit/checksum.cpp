// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/plane_fit/checksum.h"

#include <array>

#include "planecloud_slam/plane_fit/plane_cloud_codec.h"

namespace planecloud {
namespace {

using CrcTable = std::array<std::uint16_t, 256>;

constexpr CrcTable makeTable() {
  CrcTable table{};
  for (std::size_t byte = 0; byte < table.size(); ++byte) {
    auto crc = static_cast<std::uint32_t>(byte << 8);
    for (int bit = 0; bit < 8; ++bit) crc = (crc << 1) ^ ((crc & 0x8000U) != 0 ? 0x1021U : 0U);
    table[byte] = static_cast<std::uint16_t>(crc & 0xFFFFU);
  }
  return table;
}

constexpr CrcTable kTable = makeTable();

}  // namespace

std::uint16_t streamChecksum(const CameraIntrinsics& camera, const std::uint8_t* bytes,
                             std::size_t size) {
  std::uint32_t crc = 0xFFFF;
  const auto add = [&crc](std::uint32_t byte) {
    crc = ((crc << 8) & 0xFFFFU) ^ kTable[((crc >> 8) ^ byte) & 255U];
  };
  for (const int side : {camera.width, camera.height}) {
    add(static_cast<std::uint32_t>(side) & 255U);
    add(static_cast<std::uint32_t>(side) >> 8);
  }
  for (std::size_t i = 0; i < size; ++i) add(bytes[i]);
  return static_cast<std::uint16_t>(crc);
}

void requireChecksum(const CameraIntrinsics& camera, const std::vector<std::uint8_t>& bytes) {
  const std::size_t size = bytes.size();
  if (size < 2 || streamChecksum(camera, bytes.data(), size - 2) !=
                      (bytes[size - 2] | (bytes[size - 1] << 8))) {
    throw PlaneCloudDecodeError("plane cloud: wrong checksum, the stream is truncated or corrupt");
  }
}

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "planecloud_slam/plane_fit/plane_cloud_codec.h"

namespace planecloud {

/// Appends little-endian numbers.
class ByteWriter {
 public:
  explicit ByteWriter(std::vector<std::uint8_t>& bytes) : bytes_(bytes) {}

  void u8(int value) { bytes_.push_back(static_cast<std::uint8_t>(value)); }
  void u16(std::uint32_t value) { fixed(value, 2); }
  void u32(std::uint32_t value) { fixed(value, 4); }
  void f32(float value) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &value, sizeof(bits));
    u32(bits);
  }
  /// 7 bits a byte, lowest first; the high bit says that more follow.
  void varint(std::uint32_t value) {
    for (; value >= 128; value >>= 7) u8(static_cast<int>(value & 127U) | 128);
    u8(static_cast<int>(value));
  }

 private:
  void fixed(std::uint32_t value, int size) {
    for (int i = 0; i < size; ++i) u8(static_cast<int>((value >> (8 * i)) & 255U));
  }
  std::vector<std::uint8_t>& bytes_;
};

/// Reads them back; throws PlaneCloudDecodeError at the end of the bytes.
class ByteReader {
 public:
  ByteReader(const std::uint8_t* bytes, std::size_t size) : bytes_(bytes), size_(size) {}

  [[nodiscard]] std::uint32_t u8() {
    if (position_ == size_) throw PlaneCloudDecodeError("plane cloud: the stream is truncated");
    return bytes_[position_++];
  }
  [[nodiscard]] std::uint32_t u16() { return fixed(2); }
  [[nodiscard]] std::uint32_t u32() { return fixed(4); }
  [[nodiscard]] float f32() {
    const std::uint32_t bits = u32();
    float value = 0.0F;
    std::memcpy(&value, &bits, sizeof(value));
    return value;
  }
  [[nodiscard]] std::uint32_t varint() {
    std::uint32_t value = 0;
    for (int shift = 0; shift < 28; shift += 7) {
      const std::uint32_t byte = u8();
      value |= (byte & 127U) << shift;
      if (byte < 128U) return value;
    }
    throw PlaneCloudDecodeError("plane cloud: impossible number of planes");
  }
  [[nodiscard]] const std::uint8_t* rest() const { return bytes_ + position_; }
  [[nodiscard]] std::size_t left() const { return size_ - position_; }

 private:
  [[nodiscard]] std::uint32_t fixed(int size) {
    std::uint32_t value = 0;
    for (int i = 0; i < size; ++i) value |= u8() << (8 * i);
    return value;
  }
  const std::uint8_t* bytes_;
  std::size_t size_;
  std::size_t position_ = 0;
};

}  // namespace planecloud

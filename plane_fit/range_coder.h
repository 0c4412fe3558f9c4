// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace planecloud_slam {

/// The probability of a bit being 1, learnt while coding: the mean of a fast and a slow estimate.
class AdaptiveBit {
 public:
  static constexpr int kPrecision = 15;

  /// Of a 1, in 2^-15, never 0 nor 1.
  [[nodiscard]] std::uint32_t probability() const {
    return ((static_cast<std::uint32_t>(fast_) + slow_) >> 2) | 1U;
  }
  void update(bool bit) {
    const std::uint32_t target = bit ? 65535U - 127U : 127U;
    fast_ = adapt(fast_, target, 4);
    slow_ = adapt(slow_, target, 7);
  }

 private:
  static std::uint16_t adapt(std::uint16_t estimate, std::uint32_t target, int rate) {
    const int step = (static_cast<int>(target) - estimate) / (1 << rate);
    return static_cast<std::uint16_t>(estimate + step);
  }
  std::uint16_t fast_ = 32768;
  std::uint16_t slow_ = 32768;
};

/// Binary range encoder (carry-propagating, 32-bit range). Appends to a byte vector.
class RangeEncoder {
 public:
  explicit RangeEncoder(std::vector<std::uint8_t>& bytes) : bytes_(bytes), begin_(bytes.size()) {}

  /// Returns `bit`, so that one routine serves both directions.
  bool code(bool bit, AdaptiveBit& model);
  /// The `count` low bits of `value` without a model, highest first.
  std::uint32_t codeRaw(std::uint32_t value, int count);
  /// An upper bound of the bytes that `finish` would leave behind `bytes.size()` at construction.
  [[nodiscard]] std::size_t bytesSoFar() const { return bytes_.size() - begin_ + pending_ + 5; }
  /// Writes as few bytes as tell the last bits. Trailing zeros are left out: the decoder reads
  /// zeros there.
  void finish();

 private:
  void normalise();
  void shiftLow();

  std::vector<std::uint8_t>& bytes_;
  std::size_t begin_;
  std::uint64_t low_ = 0;
  std::uint32_t range_ = 0xFFFFFFFFU;
  std::uint8_t cache_ = 0;
  std::size_t pending_ = 0;  // bytes that a carry may still change, the cache included
};

/// The inverse. Reads zeros behind the end, which it cannot tell from a stream cut short: lengths
/// and checksums are the caller's.
class RangeDecoder {
 public:
  RangeDecoder(const std::uint8_t* bytes, std::size_t size);

  /// The argument is ignored, see `RangeEncoder::code`.
  bool code(bool bit, AdaptiveBit& model);
  std::uint32_t codeRaw(std::uint32_t value, int count);
  /// All bytes were read and they end as `RangeEncoder::finish` would have left them.
  [[nodiscard]] bool atEnd() const;

 private:
  void normalise();
  [[nodiscard]] std::uint8_t nextByte();

  const std::uint8_t* bytes_;
  std::size_t size_;
  std::size_t position_ = 0;
  std::uint32_t last_bytes_ = 0;  // the four read last
  std::uint32_t code_ = 0;        // less the encoder's low end
  std::uint32_t range_ = 0xFFFFFFFFU;
};

}  // namespace planecloud_slam

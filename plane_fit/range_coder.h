// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace planecloud {

/// The probability of a bit being 1, learnt while coding: the mean of a fast and a slow estimate,
/// both of which begin as running means.
class AdaptiveBit {
 public:
  static constexpr int kPrecision = 15;

  /// Of a 1, in 2^-15, never 0 nor 1.
  [[nodiscard]] std::uint32_t probability() const {
    return ((static_cast<std::uint32_t>(fast_) + slow_) >> 2) | 1U;
  }
  void update(bool bit) {
    const int target = bit ? 65535 - kMargin : kMargin;
    fast_ = adapt(fast_, target, std::min(count_ + 2, kFastInertia));
    slow_ = adapt(slow_, target, std::min(count_ + 2, kSlowInertia));
    count_ = static_cast<std::uint8_t>(std::min(count_ + 1, kSlowInertia));
  }

 private:
  static constexpr int kMargin = 127;
  static constexpr int kFastInertia = 16;
  static constexpr int kSlowInertia = 128;
  /// 2^15 / i: dividing twice a bit would take a fifth of the decoder's time.
  static constexpr std::array<int, kSlowInertia + 1> kReciprocals = [] {
    std::array<int, kSlowInertia + 1> reciprocals{};
    for (int i = 1; i <= kSlowInertia; ++i) {
      reciprocals[static_cast<std::size_t>(i)] = (1 << 15) / i;
    }
    return reciprocals;
  }();

  static std::uint16_t adapt(std::uint16_t estimate, int target, int inertia) {
    const int step = (target - estimate) * kReciprocals[static_cast<std::size_t>(inertia)];
    return static_cast<std::uint16_t>(estimate + step / (1 << 15));
  }
  std::uint16_t fast_ = 32768;
  std::uint16_t slow_ = 32768;
  std::uint8_t count_ = 0;
};

/// Binary range encoder (carry-propagating, 32-bit range). Appends to a byte vector.
class RangeEncoder {
 public:
  explicit RangeEncoder(std::vector<std::uint8_t>& bytes) : bytes_(bytes), begin_(bytes.size()) {}

  /// Returns `bit`, so that one routine serves both directions.
  bool code(bool bit, AdaptiveBit& model);
  /// The `count` low bits of `value` without a model, highest first.
  std::uint32_t codeRaw(std::uint32_t value, int count);
  /// What was coded so far takes this many bits, up to a constant.
  [[nodiscard]] double bitsSoFar() const {
    return 8.0 * static_cast<double>(bytes_.size() - begin_ + pending_) - std::log2(range_);
  }
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

}  // namespace planecloud

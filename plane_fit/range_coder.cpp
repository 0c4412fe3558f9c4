// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/plane_fit/range_coder.h"

namespace planecloud {
namespace {

constexpr std::uint32_t kMinRange = 1U << 24;

std::uint32_t split(std::uint32_t range, const AdaptiveBit& model) {
  return (range >> AdaptiveBit::kPrecision) * model.probability();
}

/// What to add to `low` for the number within [low, low + range) that has the most trailing zeros.
std::uint32_t shortestEnd(std::uint32_t low, std::uint32_t range) {
  for (int zeros = 31; zeros > 0; --zeros) {
    const std::uint32_t missing = (0U - low) & ((1U << zeros) - 1U);
    if (missing < range) return missing;
  }
  return 0;
}

}  // namespace

bool RangeEncoder::code(bool bit, AdaptiveBit& model) {
  const std::uint32_t bound = split(range_, model);
  if (bit) {
    range_ = bound;
  } else {
    low_ += bound;
    range_ -= bound;
  }
  model.update(bit);
  normalise();
  return bit;
}

std::uint32_t RangeEncoder::codeRaw(std::uint32_t value, int count) {
  for (int i = count - 1; i >= 0; --i) {
    range_ >>= 1;
    if (((value >> i) & 1U) == 0) low_ += range_;
    normalise();
  }
  return value;
}

void RangeEncoder::normalise() {
  while (range_ < kMinRange) {
    range_ <<= 8;
    shiftLow();
  }
}

void RangeEncoder::shiftLow() {
  if (pending_ == 0 || low_ < 0xFF000000U || low_ > 0xFFFFFFFFU) {
    const auto carry = static_cast<std::uint8_t>(low_ >> 32);
    for (bool first = true; pending_ > 0; --pending_, first = false) {
      bytes_.push_back(static_cast<std::uint8_t>((first ? cache_ : 0xFFU) + carry));
    }
    cache_ = static_cast<std::uint8_t>(low_ >> 24);
  }
  ++pending_;
  low_ = (low_ & 0x00FFFFFFU) << 8;
}

void RangeEncoder::finish() {
  low_ += shortestEnd(static_cast<std::uint32_t>(low_), range_);
  for (int i = 0; i < 5; ++i) shiftLow();
  while (bytes_.size() > begin_ && bytes_.back() == 0) bytes_.pop_back();
}

RangeDecoder::RangeDecoder(const std::uint8_t* bytes, std::size_t size)
    : bytes_(bytes), size_(size) {
  for (int i = 0; i < 4; ++i) code_ = (code_ << 8) | nextByte();
}

std::uint8_t RangeDecoder::nextByte() {
  const std::uint8_t byte = position_ < size_ ? bytes_[position_] : std::uint8_t{0};
  ++position_;
  last_bytes_ = (last_bytes_ << 8) | byte;
  return byte;
}

bool RangeDecoder::atEnd() const {
  if (position_ < size_ || (size_ > 0 && bytes_[size_ - 1] == 0)) return false;
  return code_ == shortestEnd(last_bytes_ - code_, range_);
}

bool RangeDecoder::code(bool /*bit*/, AdaptiveBit& model) {
  const std::uint32_t bound = split(range_, model);
  const bool bit = code_ < bound;
  if (bit) {
    range_ = bound;
  } else {
    code_ -= bound;
    range_ -= bound;
  }
  model.update(bit);
  normalise();
  return bit;
}

std::uint32_t RangeDecoder::codeRaw(std::uint32_t /*value*/, int count) {
  std::uint32_t value = 0;
  for (int i = 0; i < count; ++i) {
    range_ >>= 1;
    const bool bit = code_ < range_;
    if (!bit) code_ -= range_;
    value = (value << 1) | (bit ? 1U : 0U);
    normalise();
  }
  return value;
}

void RangeDecoder::normalise() {
  while (range_ < kMinRange) {
    range_ <<= 8;
    code_ = (code_ << 8) | nextByte();
  }
}

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "planecloud_slam/plane_fit/range_coder.h"

namespace planecloud {

/// Codes signed integers |value| < 2^26 as zero flag, sign, bit length in unary, then the bits
/// below the highest one: the first of them modelled, the others raw.
class IntegerModel {
 public:
  static constexpr int kMaxBits = 26;

  /// Codes `value` (ignored by a decoder) and returns it.
  template <typename Coder>
  std::int32_t code(Coder& coder, std::int32_t value) {
    if (coder.code(value == 0, zero_)) return 0;
    const bool negative = coder.code(value < 0, negative_);
    const auto magnitude = static_cast<std::uint32_t>(value < 0 ? -value : value);
    int bits = 1;
    while (bits < kMaxBits && coder.code((magnitude >> bits) != 0, longer_[bits])) ++bits;
    std::uint32_t coded = 1;
    if (bits > 1) {
      const bool second = coder.code(((magnitude >> (bits - 2)) & 1U) != 0, second_[bits]);
      coded = 2U | (second ? 1U : 0U);
    }
    if (bits > 2) {
      const std::uint32_t low = magnitude & ((1U << (bits - 2)) - 1U);
      coded = (coded << (bits - 2)) | coder.codeRaw(low, bits - 2);
    }
    const auto result = static_cast<std::int32_t>(coded);
    return negative ? -result : result;
  }

 private:
  AdaptiveBit zero_;
  AdaptiveBit negative_;
  AdaptiveBit longer_[kMaxBits];
  AdaptiveBit second_[kMaxBits + 1];
};

}  // namespace planecloud

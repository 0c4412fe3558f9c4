// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>

#include "planecloud_slam/plane_fit/integer_model.h"
#include "planecloud_slam/plane_fit/range_coder.h"

/// The body of a LOSSLESS stream, one routine for both directions: `Coder` is a `RangeEncoder` or a
/// `RangeDecoder`. Depths are coded as ranks among the values that occur (sensors know some
/// hundreds of them), predicted by the median edge detector of LOCO-I (Weinberger et al. 2000).
namespace planecloud {

/// The pixels around the next one that are coded already: ranks from 1, 0: no depth.
struct DepthNeighbors {
  std::int32_t west, north, northwest, northeast, far_west, far_north;
};

/// Everything that is learnt while an image is coded. Integers only.
class DepthModel {
 public:
  /// Codes one pixel (ignored by a decoder) and returns its rank, 0: no depth.
  template <typename Coder>
  std::int32_t codePixel(Coder& coder, const DepthNeighbors& around, std::int32_t rank) {
    if (coder.code(rank == 0, missing_[maskContext(around)])) {
      residual_ = 0;
      return 0;
    }
    const std::int32_t predicted = predict(around);
    residual_ = codeResidual(coder, around, rank - predicted);
    last_ = std::clamp(predicted + residual_, 1, kMaxRank);
    return last_;
  }

  static constexpr std::int32_t kMaxRank = 65535;

 private:
  static constexpr std::size_t kSteps = 5;  // of the difference of two neighbours, and: unknown
  static constexpr std::size_t kActivities = 8;
  static constexpr std::size_t kUnary = 12;

  static std::size_t maskContext(const DepthNeighbors& p) {
    return (p.west != 0 ? 1U : 0U) | (p.north != 0 ? 2U : 0U) | (p.northwest != 0 ? 4U : 0U) |
           (p.northeast != 0 ? 8U : 0U) | (p.far_west != 0 ? 16U : 0U) |
           (p.far_north != 0 ? 32U : 0U);
  }

  [[nodiscard]] std::int32_t predict(const DepthNeighbors& p) const {
    if (p.west != 0 && p.north != 0) {
      if (p.northwest == 0) return (p.west + p.north) / 2;
      const std::int32_t low = std::min(p.west, p.north);
      const std::int32_t high = std::max(p.west, p.north);
      return std::clamp(p.west + p.north - p.northwest, low, high);
    }
    for (const std::int32_t rank : {p.west, p.north, p.northeast, p.northwest}) {
      if (rank != 0) return rank;
    }
    return last_;
  }

  /// -1, 0, 1 kept apart, larger ones together, 4: one of the two is unknown.
  static std::size_t step(std::int32_t a, std::int32_t b) {
    if (a == 0 || b == 0) return kSteps - 1;
    const std::int32_t difference = a - b;
    if (difference == 0) return 0;
    if (std::abs(difference) > 1) return 3;
    return difference > 0 ? 1 : 2;
  }
  static std::size_t activity(const DepthNeighbors& p) {
    std::int32_t sum = 0;
    if (p.west != 0 && p.northwest != 0) sum += std::abs(p.west - p.northwest);
    if (p.north != 0 && p.northwest != 0) sum += std::abs(p.north - p.northwest);
    if (p.north != 0 && p.northeast != 0) sum += std::abs(p.northeast - p.north);
    std::size_t bits = 0;
    for (; sum != 0; sum >>= 1) ++bits;
    return std::min(bits, kActivities - 1);
  }

  template <typename Coder>
  std::int32_t codeResidual(Coder& coder, const DepthNeighbors& p, std::int32_t residual) {
    const std::size_t last = residual_ == 0 ? 0U : (residual_ > 0 ? 1U : 2U);
    const std::size_t texture =
        (((step(p.west, p.northwest) * kSteps + step(p.north, p.northwest)) * kSteps +
          step(p.northeast, p.north)) *
             kSteps +
         step(p.west, p.far_west)) *
            kSteps +
        step(p.north, p.far_north);
    if (coder.code(residual == 0, zero_[texture][last])) return 0;
    const bool negative = coder.code(residual < 0, negative_[texture][last]);
    const std::int32_t magnitude =
        codeMagnitude(coder, activity(p), residual < 0 ? -residual : residual);
    return negative ? -magnitude : magnitude;
  }

  template <typename Coder>
  std::int32_t codeMagnitude(Coder& coder, std::size_t context, std::int32_t magnitude) {
    std::array<AdaptiveBit, kUnary>& longer = longer_[context];
    for (std::size_t i = 0; i < kUnary; ++i) {
      const auto reached = static_cast<std::int32_t>(i) + 1;
      if (!coder.code(magnitude > reached, longer[i])) return reached;
    }
    constexpr auto kReached = static_cast<std::int32_t>(kUnary) + 1;
    return kReached + std::abs(rest_.code(coder, magnitude - kReached));
  }

  std::array<AdaptiveBit, 64> missing_;
  std::array<std::array<AdaptiveBit, 3>, kSteps * kSteps * kSteps * kSteps * kSteps> zero_;
  std::array<std::array<AdaptiveBit, 3>, kSteps * kSteps * kSteps * kSteps * kSteps> negative_;
  std::array<std::array<AdaptiveBit, kUnary>, kActivities> longer_;
  IntegerModel rest_;
  std::int32_t last_ = 1;
  std::int32_t residual_ = 0;
};

}  // namespace planecloud

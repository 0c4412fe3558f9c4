// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>

namespace planecloud {

/// The finaliser of splitmix64: every bit of the result depends on every bit of `bits`.
[[nodiscard]] constexpr std::uint64_t mixBits(std::uint64_t bits) {
  bits += 0x9e3779b97f4a7c15u;
  bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9u;
  bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebu;
  return bits ^ (bits >> 31);
}

/// Random bits that belong to a seed and up to two counters: the same whatever the order of calls,
/// so that rows may be made by several threads.
[[nodiscard]] constexpr std::uint64_t hashOf(std::uint64_t seed, std::uint64_t a,
                                             std::uint64_t b = 0) {
  return mixBits(mixBits(mixBits(seed) ^ a) ^ b);
}

/// Sum of the four 16-bit words of `bits`: close to normal, mean 131070, deviation 37837.
[[nodiscard]] constexpr std::int32_t bellShaped(std::uint64_t bits) {
  return static_cast<std::int32_t>((bits & 0xffff) + ((bits >> 16) & 0xffff) +
                                   ((bits >> 32) & 0xffff) + (bits >> 48));
}
constexpr float kBellMean = 131070.0F;
constexpr float kBellDeviation = 37837.0F;

/// A stream of random numbers that is the same with every compiler and standard library.
class SeededRandom {
 public:
  explicit SeededRandom(std::uint64_t seed) : state_(mixBits(seed)) {}

  [[nodiscard]] std::uint64_t bits() { return mixBits(state_ += 0x632be59bd9b4e019u); }
  /// In [low, high).
  [[nodiscard]] double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(bits() >> 11) * 0x1p-53;
  }
  /// In [low, high].
  [[nodiscard]] int integer(int low, int high) {
    return low + static_cast<int>(bits() % static_cast<std::uint64_t>(high - low + 1));
  }
  [[nodiscard]] bool chance(double probability) { return uniform(0.0, 1.0) < probability; }
  /// Mean 0, deviation 1; bounded by +-3.5.
  [[nodiscard]] double normal() {
    return (static_cast<double>(bellShaped(bits())) - kBellMean) / kBellDeviation;
  }

 private:
  std::uint64_t state_;
};

}  // namespace planecloud

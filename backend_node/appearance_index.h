// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "planecloud_slam/plane_fit/appearance_descriptor.h"

namespace planecloud {

/// The descriptors of all keyframes, coarser: bands of three rows, a byte of brightness and one of
/// depth for each column of a band. Looking through ten thousand of them takes a millisecond where
/// comparing the descriptors themselves would take a fifth of a second. Grows keyframe by keyframe.
class AppearanceIndex {
 public:
  /// Appends the next keyframe's descriptor; one that is empty or malformed is like nothing.
  void add(const std::vector<std::uint8_t>& descriptor);

  [[nodiscard]] std::size_t size() const { return sketches_.size(); }

  /// The keyframes among those `wanted` that are most like `descriptor`, best first, at most
  /// `count`. Which of them really are alike is for compareAppearance to say.
  [[nodiscard]] std::vector<int> mostAlike(const std::vector<std::uint8_t>& descriptor,
                                           const std::function<bool(int)>& wanted,
                                           std::size_t count) const;

 private:
  static constexpr int kColumns = kAppearanceColumns;
  static constexpr int kRowsOfBand = 3;
  static constexpr int kBands = kAppearanceRows / kRowsOfBand;

  /// Column by column, so that views turned against each other compare in one run.
  using Cells = std::array<std::uint8_t, kColumns * kBands>;
  struct Sketch {
    Cells grey{};
    Cells depth{};
    bool empty = true;
  };

  [[nodiscard]] static Sketch sketch(const std::vector<std::uint8_t>& descriptor);
  [[nodiscard]] static double distance(const Sketch& a, const Sketch& b);

  std::vector<Sketch> sketches_;
};

}  // namespace planecloud

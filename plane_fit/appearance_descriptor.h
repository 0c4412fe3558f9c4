// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "planecloud_slam/plane_fit/image_view.h"

namespace planecloud {

/// The grid of the descriptor; after a byte of version it has a byte a cell, row by row: low half
/// brightness, high half depth.
inline constexpr int kAppearanceColumns = 20;
inline constexpr int kAppearanceRows = 12;
inline constexpr std::size_t kAppearanceBytes = 1 + kAppearanceColumns * kAppearanceRows;

/// A compact description of what a keyframe looks like, for recognising places without any
/// position: brightness and logarithmic depth on a grid of 20 x 12 cells, four bits each, 241
/// bytes. Brightness counts in deviations of the image, so exposure does not matter; depths are
/// metric and see what bare walls do not show. Randomised ferns (Glocker et al., TVCG 2015) over
/// the same images were measured first: they cannot be shifted against each other, and found half
/// of the revisits that this finds at the same rate of false ones.
///
/// `grey` [0..255] and `depth` [m, NaN or <= 0: none] show the same view; sizes may differ. An
/// empty or all-invalid depth is allowed. Returns no bytes when `grey` is smaller than the grid.
[[nodiscard]] std::vector<std::uint8_t> makeAppearanceDescriptor(ImageView<std::uint8_t> grey,
                                                                 ImageView<float> depth);

/// How two descriptors compare where one is shifted best against the other: by up to 30 % of the
/// image sideways and 17 % up or down, which is what a turned head does.
struct AppearanceComparison {
  /// [0, 1]: below 0.3 for most views of one place, 0.6 in the middle for different places.
  double dissimilarity = 1.0;
  double shift_x = 0.0;  ///< what `b` shows lies this far to the right in `a` [image widths]
  double shift_y = 0.0;  ///< and this far down [image heights]
};

/// None when either descriptor is empty, malformed or of another version. The same on every
/// machine; exchanging `a` and `b` keeps the dissimilarity and turns the shift around.
[[nodiscard]] std::optional<AppearanceComparison> compareAppearance(
    const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b);

/// `compareAppearance` without the shift.
[[nodiscard]] std::optional<double> appearanceDissimilarity(const std::vector<std::uint8_t>& a,
                                                            const std::vector<std::uint8_t>& b);

}  // namespace planecloud

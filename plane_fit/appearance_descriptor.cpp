// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/plane_fit/appearance_descriptor.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace planecloud {
namespace {

// All of this is the meaning of version 1 of the bytes: change anything and the version changes.
constexpr std::uint8_t kDescriptorVersion = 1;
constexpr int kColumns = kAppearanceColumns;
constexpr int kRows = kAppearanceRows;
constexpr double kLevelsPerDeviation = 3.0;
constexpr int kGreyMiddle = 8;          // brightness is 1..15 around it
constexpr int kDepthLevels = 15;        // depth is 1..15, 0: none
const double kNearest = std::log(0.4);  // level 1 [ln m]
const double kDepthStep = (std::log(8.0) - kNearest) / (kDepthLevels - 1);  // [ln m]

constexpr int kShiftColumns = 6;
constexpr int kShiftRows = 2;
constexpr int kLargestDepthDifference = 3;  // [levels]; larger ones count the same
constexpr double kGreyShare = 2.0 / 3.0;    // of brightness in the sum, the rest is depth
// Variance added to either image [levels^2], so that noise on bare walls correlates with nothing.
constexpr double kFlatVariance = 0.45;
constexpr double kSpread = 2.0;  // uncorrelated views are 0.5 apart: uses the range up to 1

/// Mean of `read(pixel)` over each cell, NaN where less than a quarter of the cell's pixels are
/// valid (`read` gives NaN for the others).
template <typename Pixel, typename Read>
Image<double> shrink(const ImageView<Pixel>& image, Read read) {
  Image<double> cells(kColumns, kRows, std::numeric_limits<double>::quiet_NaN());
  for (int row = 0; row < kRows; ++row) {
    const int y0 = image.height() * row / kRows;
    const int y1 = image.height() * (row + 1) / kRows;
    for (int column = 0; column < kColumns; ++column) {
      const int x0 = image.width() * column / kColumns;
      const int x1 = image.width() * (column + 1) / kColumns;
      double sum = 0.0;
      int valid = 0;
      for (int y = y0; y < y1; ++y) {
        for (int x = x0; x < x1; ++x) {
          const double value = read(image(x, y));
          if (std::isnan(value)) continue;
          sum += value;
          ++valid;
        }
      }
      if (valid > 0 && 4 * valid >= (x1 - x0) * (y1 - y0)) cells(column, row) = sum / valid;
    }
  }
  return cells;
}

/// Brightness of each cell in standard deviations from the image's mean, as levels 1..15.
Image<int> greyLevels(const ImageView<std::uint8_t>& grey) {
  const Image<double> cells =
      shrink(grey, [](std::uint8_t value) { return static_cast<double>(value); });
  const double count = static_cast<double>(cells.size());
  double mean = 0.0;
  for (const double value : cells) mean += value / count;
  double variance = 0.0;
  for (const double value : cells) variance += (value - mean) * (value - mean) / count;
  const double scale = kLevelsPerDeviation / std::max(1.0, std::sqrt(variance));
  Image<int> levels(kColumns, kRows);
  std::transform(cells.begin(), cells.end(), levels.begin(), [&](double value) {
    const int level = static_cast<int>(std::lround((value - mean) * scale));
    return kGreyMiddle + std::clamp(level, 1 - kGreyMiddle, kGreyMiddle - 1);
  });
  return levels;
}

/// Logarithm of each cell's depth as levels 1..15, 0 where there is none. The mean is taken over
/// inverse depths, whose noise is even.
Image<int> depthLevels(const ImageView<float>& depth) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  const Image<double> cells = shrink(
      depth, [none](float z) { return z > 0.0F && std::isfinite(z) ? 1.0 / double{z} : none; });
  Image<int> levels(kColumns, kRows);
  std::transform(cells.begin(), cells.end(), levels.begin(), [](double inverse_depth) {
    if (std::isnan(inverse_depth)) return 0;
    const double level = (-std::log(inverse_depth) - kNearest) / kDepthStep;
    return 1 + static_cast<int>(std::lround(std::clamp(level, 0.0, kDepthLevels - 1.0)));
  });
  return levels;
}

bool isWellFormed(const std::vector<std::uint8_t>& bytes) {
  return bytes.size() == kAppearanceBytes && bytes[0] == kDescriptorVersion &&
         std::all_of(bytes.begin() + 1, bytes.end(), [](std::uint8_t b) { return (b & 15) != 0; });
}

/// Integer sums over the cells two shifted descriptors share.
struct Sums {
  int cells = 0;
  int a = 0;
  int b = 0;
  int aa = 0;
  int bb = 0;
  int ab = 0;
  int depth_cells = 0;
  int depth_difference = 0;

  void add(int byte_a, int byte_b) {
    const int grey_a = (byte_a & 15) - kGreyMiddle;
    const int grey_b = (byte_b & 15) - kGreyMiddle;
    ++cells;
    a += grey_a;
    b += grey_b;
    aa += grey_a * grey_a;
    bb += grey_b * grey_b;
    ab += grey_a * grey_b;
    const int depth_a = byte_a >> 4;
    const int depth_b = byte_b >> 4;
    const int known = depth_a != 0 && depth_b != 0 ? 1 : 0;
    depth_cells += known;
    depth_difference += known * std::min(std::abs(depth_a - depth_b), kLargestDepthDifference);
  }

  /// Half of one minus the normalised correlation of brightness, joined by the mean depth
  /// difference where a quarter of the cells know theirs.
  [[nodiscard]] double dissimilarity() const {
    const double n = cells;
    const double covariance = ab / n - (a / n) * (b / n);
    const double variance_a = aa / n - (a / n) * (a / n) + kFlatVariance;
    const double variance_b = bb / n - (b / n) * (b / n) + kFlatVariance;
    const double grey = 0.5 - 0.5 * covariance / std::sqrt(variance_a * variance_b);
    if (4 * depth_cells < cells) return std::min(1.0, kSpread * grey);
    const double depth =
        static_cast<double>(depth_difference) / (depth_cells * kLargestDepthDifference);
    return std::min(1.0, kSpread * (kGreyShare * grey + (1.0 - kGreyShare) * depth));
  }
};

Sums sumsAt(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b, int shift_x,
            int shift_y) {
  Sums sums;
  const int x_begin = std::max(0, shift_x);
  const int x_end = kColumns + std::min(0, shift_x);
  for (int y = std::max(0, shift_y); y < kRows + std::min(0, shift_y); ++y) {
    const std::uint8_t* row_a = a.data() + 1 + y * kColumns;
    const std::uint8_t* row_b = b.data() + 1 + (y - shift_y) * kColumns - shift_x;
    for (int x = x_begin; x < x_end; ++x) sums.add(row_a[x], row_b[x]);
  }
  return sums;
}

}  // namespace

std::vector<std::uint8_t> makeAppearanceDescriptor(ImageView<std::uint8_t> grey,
                                                   ImageView<float> depth) {
  if (grey.width() < kColumns || grey.height() < kRows) return {};
  const Image<int> brightness = greyLevels(grey);
  const Image<int> distance = depthLevels(depth);
  std::vector<std::uint8_t> bytes{kDescriptorVersion};
  for (int y = 0; y < kRows; ++y) {
    for (int x = 0; x < kColumns; ++x) {
      bytes.push_back(static_cast<std::uint8_t>(brightness(x, y) + 16 * distance(x, y)));
    }
  }
  return bytes;
}

std::optional<AppearanceComparison> compareAppearance(const std::vector<std::uint8_t>& a,
                                                      const std::vector<std::uint8_t>& b) {
  if (!isWellFormed(a) || !isWellFormed(b)) return std::nullopt;
  AppearanceComparison best;
  // Small shifts first, so that of equal ones the smallest wins, whichever way round.
  for (int distance = 0; distance <= kShiftColumns + kShiftRows; ++distance) {
    for (int y = -kShiftRows; y <= kShiftRows; ++y) {
      for (int x = -kShiftColumns; x <= kShiftColumns; ++x) {
        if (std::abs(x) + std::abs(y) != distance) continue;
        const double dissimilarity = sumsAt(a, b, x, y).dissimilarity();
        if (dissimilarity >= best.dissimilarity) continue;
        best = {dissimilarity, static_cast<double>(x) / kColumns, static_cast<double>(y) / kRows};
      }
    }
  }
  return best;
}

std::optional<double> appearanceDissimilarity(const std::vector<std::uint8_t>& a,
                                              const std::vector<std::uint8_t>& b) {
  const std::optional<AppearanceComparison> comparison = compareAppearance(a, b);
  if (!comparison) return std::nullopt;
  return comparison->dissimilarity;
}

}  // namespace planecloud

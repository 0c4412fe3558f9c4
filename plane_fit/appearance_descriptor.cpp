// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/plane_fit/appearance_descriptor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace planecloud_slam {
namespace {

// All of this is the meaning of version 1 of the bytes: change anything and the version changes.
constexpr std::uint8_t kVersion = 1;
constexpr int kColumns = 40;  // of the small images
constexpr int kRows = 30;
constexpr std::size_t kGreyFerns = 160;
constexpr std::size_t kDepthFerns = 320;
constexpr std::size_t kFerns = kGreyFerns + kDepthFerns;
constexpr std::size_t kTests = 3;  // binary tests a fern, stored as one code of kTests bits
constexpr std::size_t kCodeBytes = kFerns * kTests / 8;
constexpr std::size_t kMaskBytes = kFerns / 8;
constexpr std::size_t kBytes = 1 + kCodeBytes + kMaskBytes;
static_assert(kFerns % 8 == 0 && kBytes < 300, "codes fill whole bytes, 300 bytes at most");
constexpr std::size_t kLeastKnown = kFerns / 8;  // ferns known in both, to compare at all

/// The numbers of Knuth's MMIX generator: the same ferns on every machine.
class Lcg {
 public:
  /// Uniform in [0, 1).
  float uniform() {
    state_ = state_ * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<float>(state_ >> 40) * 0x1p-24F;
  }
  float uniform(float low, float high) { return low + (high - low) * uniform(); }
  int below(int end) { return static_cast<int>(uniform() * static_cast<float>(end)); }

 private:
  std::uint64_t state_ = 20260101;
};

/// Is the first place brighter (nearer) than the second by more than `threshold`?
struct FernTest {
  int x0 = 0;
  int y0 = 0;
  int x1 = 0;
  int y1 = 0;
  float threshold = 0.0F;  ///< grey: in deviations of the image; depth: see `isFarther`
  bool absolute = false;   ///< the first place against the threshold alone
};

using Fern = std::array<FernTest, kTests>;

FernTest drawPair(Lcg& random, float spread) {
  FernTest test;
  test.x0 = random.below(kColumns);
  test.y0 = random.below(kRows);
  test.x1 = random.below(kColumns);
  test.y1 = random.below(kRows);
  test.threshold = random.uniform(-spread, spread);
  return test;
}

/// Grey ferns first. Of the depths, which are metric, the first test is an absolute one.
std::vector<Fern> drawFerns() {
  Lcg random;
  std::vector<Fern> ferns(kFerns);
  for (std::size_t i = 0; i < kFerns; ++i) {
    for (std::size_t k = 0; k < kTests; ++k) {
      const bool grey = i < kGreyFerns;
      ferns[i][k] = drawPair(random, grey ? 0.7F : 0.4F);
      if (grey || k > 0) continue;
      ferns[i][k].absolute = true;
      ferns[i][k].threshold = random.uniform(std::log(0.7F), std::log(5.0F));
    }
  }
  return ferns;
}

const std::vector<Fern>& allFerns() {
  static const std::vector<Fern> ferns = drawFerns();
  return ferns;
}

/// Mean of `read(pixel)` over each cell of a kColumns x kRows grid, NaN where less than a quarter
/// of the cell's pixels are valid (`read` gives NaN for the others).
template <typename Pixel, typename Read>
Image<float> shrink(const ImageView<Pixel>& image, Read read) {
  Image<float> small(kColumns, kRows, std::numeric_limits<float>::quiet_NaN());
  if (image.empty()) return small;
  for (int row = 0; row < kRows; ++row) {
    const int y0 = image.height() * row / kRows;
    const int y1 = std::max(y0 + 1, image.height() * (row + 1) / kRows);
    for (int column = 0; column < kColumns; ++column) {
      const int x0 = image.width() * column / kColumns;
      const int x1 = std::max(x0 + 1, image.width() * (column + 1) / kColumns);
      double sum = 0.0;
      int valid = 0;
      for (int y = y0; y < y1; ++y) {
        for (int x = x0; x < x1; ++x) {
          const float value = read(image(x, y));
          if (std::isnan(value)) continue;
          sum += value;
          ++valid;
        }
      }
      if (4 * valid >= (x1 - x0) * (y1 - y0) && valid > 0) {
        small(column, row) = static_cast<float>(sum / valid);
      }
    }
  }
  return small;
}

/// 3 x 3 mean of what is valid; invalid places stay invalid.
Image<float> blur(const Image<float>& image) {
  Image<float> smooth = image;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      if (std::isnan(image(x, y))) continue;
      float sum = 0.0F;
      float count = 0.0F;
      for (int v = std::max(0, y - 1); v <= std::min(image.height() - 1, y + 1); ++v) {
        for (int u = std::max(0, x - 1); u <= std::min(image.width() - 1, x + 1); ++u) {
          if (std::isnan(image(u, v))) continue;
          sum += image(u, v);
          count += 1.0F;
        }
      }
      smooth(x, y) = sum / count;
    }
  }
  return smooth;
}

/// Brightness in mean absolute deviations from the image's mean: exposure drops out.
Image<float> normalisedGrey(const ImageView<std::uint8_t>& grey) {
  Image<float> small =
      blur(shrink(grey, [](std::uint8_t value) { return static_cast<float>(value); }));
  float mean = 0.0F;
  for (const float value : small) mean += value / static_cast<float>(small.size());
  float deviation = 0.0F;
  for (const float value : small) {
    deviation += std::abs(value - mean) / static_cast<float>(small.size());
  }
  const float scale = 1.0F / std::max(deviation, 1.0F);
  for (float& value : small) value = (value - mean) * scale;
  return small;
}

/// Logarithm of the depth [m]; the mean is taken over inverse depths, whose noise is even.
Image<float> logarithmicDepth(const ImageView<float>& depth) {
  const float none = std::numeric_limits<float>::quiet_NaN();
  Image<float> small = blur(
      shrink(depth, [none](float z) { return z > 0.0F && std::isfinite(z) ? 1.0F / z : none; }));
  for (float& value : small) value = -std::log(value);
  return small;
}

void setBit(std::vector<std::uint8_t>& bytes, std::size_t bit) {
  bytes[bit / 8] = static_cast<std::uint8_t>(bytes[bit / 8] | (1U << (bit % 8)));
}

bool bitAt(const std::vector<std::uint8_t>& bytes, std::size_t bit) {
  return ((bytes[bit / 8] >> (bit % 8)) & 1U) != 0;
}

bool isWellFormed(const std::vector<std::uint8_t>& bytes) {
  return bytes.size() == kBytes && bytes[0] == kVersion;
}

constexpr std::size_t kCodeStart = 8;                            // first bit of the codes
constexpr std::size_t kMaskStart = kCodeStart + 8 * kCodeBytes;  // first bit of "known"

}  // namespace

std::vector<std::uint8_t> makeAppearanceDescriptor(ImageView<std::uint8_t> grey,
                                                   ImageView<float> depth) {
  if (grey.empty()) return {};
  const Image<float> brightness = normalisedGrey(grey);
  const Image<float> distance = logarithmicDepth(depth);
  std::vector<std::uint8_t> bytes(kBytes, 0);
  bytes[0] = kVersion;
  const std::vector<Fern>& ferns = allFerns();
  for (std::size_t i = 0; i < kFerns; ++i) {
    const Image<float>& image = i < kGreyFerns ? brightness : distance;
    bool known = true;
    for (std::size_t k = 0; k < kTests; ++k) {
      const FernTest& test = ferns[i][k];
      const float other = test.absolute ? 0.0F : image(test.x1, test.y1);
      const float difference = image(test.x0, test.y0) - other;
      known = known && !std::isnan(difference);
      if (difference > test.threshold) setBit(bytes, kCodeStart + i * kTests + k);
    }
    if (known) setBit(bytes, kMaskStart + i);
  }
  return bytes;
}

std::optional<double> appearanceDissimilarity(const std::vector<std::uint8_t>& a,
                                              const std::vector<std::uint8_t>& b) {
  if (!isWellFormed(a) || !isWellFormed(b)) return std::nullopt;
  std::size_t known = 0;
  std::size_t different = 0;
  for (std::size_t i = 0; i < kFerns; ++i) {
    if (!bitAt(a, kMaskStart + i) || !bitAt(b, kMaskStart + i)) continue;
    ++known;
    bool same = true;
    for (std::size_t k = 0; k < kTests; ++k) {
      const std::size_t bit = kCodeStart + i * kTests + k;
      same = same && bitAt(a, bit) == bitAt(b, bit);
    }
    different += same ? 0U : 1U;
  }
  if (known < kLeastKnown) return std::nullopt;
  return static_cast<double>(different) / static_cast<double>(known);
}

}  // namespace planecloud_slam

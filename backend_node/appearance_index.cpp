// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/backend_node/appearance_index.h"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <utility>

namespace planecloud {
namespace {

constexpr int kMostShift = 6;  ///< of a view to the side [columns]
constexpr int kGreyScale = 5;  ///< of a sum over a band: 1..15 three times to a byte
constexpr int kDepthScale = 5;

/// Sum of absolute differences.
int difference(const std::uint8_t* a, const std::uint8_t* b, int count) {
  int sum = 0;
  for (int i = 0; i < count; ++i) sum += std::abs(a[i] - b[i]);
  return sum;
}

}  // namespace

AppearanceIndex::Sketch AppearanceIndex::sketch(const std::vector<std::uint8_t>& descriptor) {
  Sketch sketch;
  sketch.empty = descriptor.size() != kAppearanceBytes;
  if (sketch.empty) return sketch;
  for (int column = 0; column < kColumns; ++column) {
    for (int band = 0; band < kBands; ++band) {
      int grey = 0;
      int depth = 0;
      for (int row = kRowsOfBand * band; row < kRowsOfBand * (band + 1); ++row) {
        const std::uint8_t cell = descriptor[static_cast<std::size_t>(1 + row * kColumns + column)];
        grey += cell & 15;
        depth += cell >> 4;
      }
      const auto place = static_cast<std::size_t>(column * kBands + band);
      sketch.grey[place] = static_cast<std::uint8_t>(kGreyScale * grey);
      sketch.depth[place] = static_cast<std::uint8_t>(kDepthScale * depth);
    }
  }
  return sketch;
}

double AppearanceIndex::distance(const Sketch& a, const Sketch& b) {
  double least = std::numeric_limits<double>::infinity();
  for (int shift = -kMostShift; shift <= kMostShift; ++shift) {
    const std::size_t from_a = static_cast<std::size_t>(kBands * std::max(0, shift));
    const std::size_t from_b = static_cast<std::size_t>(kBands * std::max(0, -shift));
    const int cells = kBands * (kColumns - std::abs(shift));
    const int sum = difference(a.grey.data() + from_a, b.grey.data() + from_b, cells) +
                    difference(a.depth.data() + from_a, b.depth.data() + from_b, cells);
    least = std::min(least, static_cast<double>(sum) / cells);
  }
  return least;
}

void AppearanceIndex::add(const std::vector<std::uint8_t>& descriptor) {
  sketches_.push_back(sketch(descriptor));
}

std::vector<int> AppearanceIndex::mostAlike(const std::vector<std::uint8_t>& descriptor,
                                            const std::function<bool(int)>& wanted,
                                            std::size_t count) const {
  const Sketch query = sketch(descriptor);
  std::vector<std::pair<double, int>> ranked;
  for (std::size_t i = 0; i < sketches_.size() && !query.empty; ++i) {
    if (sketches_[i].empty || !wanted(static_cast<int>(i))) continue;
    ranked.emplace_back(distance(query, sketches_[i]), static_cast<int>(i));
  }
  const std::size_t kept = std::min(count, ranked.size());
  std::partial_sort(ranked.begin(), ranked.begin() + static_cast<std::ptrdiff_t>(kept),
                    ranked.end());
  std::vector<int> result;
  for (std::size_t i = 0; i < kept; ++i) result.push_back(ranked[i].second);
  return result;
}

}  // namespace planecloud

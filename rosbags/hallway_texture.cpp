// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/rosbags/hallway_texture.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace planecloud {
namespace {

constexpr int kMaxProbes = 3;

std::uint8_t meanOf(std::uint8_t a, std::uint8_t b, std::uint8_t c, std::uint8_t d) {
  return static_cast<std::uint8_t>((a + b + c + d + 2) / 4);
}

Rgb8 meanOf(const Rgb8& a, const Rgb8& b, const Rgb8& c, const Rgb8& d) {
  return {meanOf(a.r, b.r, c.r, d.r), meanOf(a.g, b.g, c.g, d.g), meanOf(a.b, b.b, c.b, d.b)};
}

template <typename Texel>
Image<Texel> halved(const Image<Texel>& fine) {
  Image<Texel> coarse(fine.width() / 2, fine.height() / 2);
  for (int y = 0; y < coarse.height(); ++y) {
    const Texel* upper = fine.row(2 * y);
    const Texel* lower = fine.row(2 * y + 1);
    for (int x = 0; x < coarse.width(); ++x) {
      coarse(x, y) = meanOf(upper[2 * x], upper[2 * x + 1], lower[2 * x], lower[2 * x + 1]);
    }
  }
  return coarse;
}

float valueOf(std::uint8_t texel) { return static_cast<float>(texel); }

Eigen::Array3f valueOf(const Rgb8& texel) {
  return {static_cast<float>(texel.r), static_cast<float>(texel.g), static_cast<float>(texel.b)};
}

int floorToInt(float value) {
  const int truncated = static_cast<int>(value);
  return truncated - (value < static_cast<float>(truncated) ? 1 : 0);
}

template <typename Texel>
typename MipTexture<Texel>::Value bilinear(const Image<Texel>& level, float x, float y) {
  const int column = floorToInt(x);
  const int row = floorToInt(y);
  const float fx = x - static_cast<float>(column);
  const float fy = y - static_cast<float>(row);
  const int mask = level.width() - 1;
  const int x0 = column & mask;
  const int x1 = (column + 1) & mask;
  const Texel* upper = level.row(row & mask);
  const Texel* lower = level.row((row + 1) & mask);
  return valueOf(upper[x0]) * ((1.0F - fx) * (1.0F - fy)) +
         valueOf(upper[x1]) * (fx * (1.0F - fy)) + valueOf(lower[x0]) * ((1.0F - fx) * fy) +
         valueOf(lower[x1]) * (fx * fy);
}

/// log2 with a linear mantissa (error below 0.09), 0 for values below 1.
float approximateLog2(float value) {
  if (value <= 1.0F) return 0.0F;
  std::uint32_t bits = 0;
  std::memcpy(&bits, &value, sizeof(bits));
  const auto exponent = static_cast<int>(bits >> 23) - 127;
  return static_cast<float>(exponent) + static_cast<float>(bits & 0x7fffffu) * 0x1p-23F;
}

}  // namespace

template <typename Texel>
MipTexture<Texel>::MipTexture(Image<Texel> finest) {
  const int side = finest.width();
  if (side < 2 || side != finest.height() || (side & (side - 1)) != 0) {
    throw std::invalid_argument("a texture must be square with a power of two as its side");
  }
  levels_.push_back(std::move(finest));
  while (levels_.back().width() > 1) levels_.push_back(halved(levels_.back()));
}

template <typename Texel>
typename MipTexture<Texel>::Value MipTexture<Texel>::probe(const Eigen::Vector2f& centre,
                                                           float level) const {
  const int top = static_cast<int>(levels_.size()) - 1;
  const int fine = std::min(static_cast<int>(level), top);
  const auto at = [&](int index) {
    const float scale = 1.0F / static_cast<float>(1 << index);
    return bilinear(levels_[static_cast<std::size_t>(index)], centre.x() * scale - 0.5F,
                    centre.y() * scale - 0.5F);
  };
  // Half of all probes lie near enough to one level to do without the other.
  const float blend = std::clamp(2.0F * (level - static_cast<float>(fine)) - 0.5F, 0.0F, 1.0F);
  if (blend == 1.0F && fine < top) return at(fine + 1);
  const Value fine_value = at(fine);
  if (blend == 0.0F || fine == top) return fine_value;
  return fine_value * (1.0F - blend) + at(fine + 1) * blend;
}

template <typename Texel>
typename MipTexture<Texel>::Value MipTexture<Texel>::sample(
    const TextureFootprint& footprint) const {
  const float length = footprint.major.norm();
  const float minor = std::max(footprint.minor, 1.0F);
  const int probes = std::min(1 + static_cast<int>(length / (2.0F * minor)), kMaxProbes);
  const float level = approximateLog2(std::max(minor, length / static_cast<float>(probes)));
  if (probes == 1) return probe(footprint.centre, level);
  const float share = 1.0F / static_cast<float>(probes);
  const Eigen::Vector2f first = footprint.centre + (0.5F * share - 0.5F) * footprint.major;
  Value sum = probe(first, level);
  for (int i = 1; i < probes; ++i) {
    sum += probe(first + (static_cast<float>(i) * share) * footprint.major, level);
  }
  return sum * share;
}

template <typename Texel>
typename MipTexture<Texel>::Value MipTexture<Texel>::sampleFinest(
    const Eigen::Vector2f& centre) const {
  return bilinear(levels_.front(), centre.x() - 0.5F, centre.y() - 0.5F);
}

template class MipTexture<std::uint8_t>;
template class MipTexture<Rgb8>;

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/rosbags/hallway_texture.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace planecloud_slam {
namespace {

constexpr int kMaxProbes = 4;

Image<Rgb8> halved(const Image<Rgb8>& fine) {
  Image<Rgb8> coarse(fine.width() / 2, fine.height() / 2);
  for (int y = 0; y < coarse.height(); ++y) {
    const Rgb8* upper = fine.row(2 * y);
    const Rgb8* lower = fine.row(2 * y + 1);
    for (int x = 0; x < coarse.width(); ++x) {
      const auto mean = [&](auto channel) {
        const int sum = channel(upper[2 * x]) + channel(upper[2 * x + 1]) + channel(lower[2 * x]) +
                        channel(lower[2 * x + 1]);
        return static_cast<std::uint8_t>((sum + 2) / 4);
      };
      coarse(x, y) = {mean([](const Rgb8& p) { return int{p.r}; }),
                      mean([](const Rgb8& p) { return int{p.g}; }),
                      mean([](const Rgb8& p) { return int{p.b}; })};
    }
  }
  return coarse;
}

Eigen::Array3f toArray(const Rgb8& p) {
  return {static_cast<float>(p.r), static_cast<float>(p.g), static_cast<float>(p.b)};
}

Eigen::Array3f bilinear(const Image<Rgb8>& level, float x, float y) {
  const float floor_x = std::floor(x);
  const float floor_y = std::floor(y);
  const float fx = x - floor_x;
  const float fy = y - floor_y;
  const int mask = level.width() - 1;
  const int x0 = static_cast<int>(floor_x) & mask;
  const int x1 = (x0 + 1) & mask;
  const Rgb8* upper = level.row(static_cast<int>(floor_y) & mask);
  const Rgb8* lower = level.row((static_cast<int>(floor_y) + 1) & mask);
  return (toArray(upper[x0]) * (1.0F - fx) + toArray(upper[x1]) * fx) * (1.0F - fy) +
         (toArray(lower[x0]) * (1.0F - fx) + toArray(lower[x1]) * fx) * fy;
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

MipTexture::MipTexture(Image<Rgb8> finest) {
  const int side = finest.width();
  if (side < 2 || side != finest.height() || (side & (side - 1)) != 0) {
    throw std::invalid_argument("a texture must be square with a power of two as its side");
  }
  levels_.push_back(std::move(finest));
  while (levels_.back().width() > 1) levels_.push_back(halved(levels_.back()));
}

Eigen::Array3f MipTexture::probe(const Eigen::Vector2f& centre, float level) const {
  const int top = static_cast<int>(levels_.size()) - 1;
  const int fine = std::min(static_cast<int>(level), top);
  const auto at = [&](int index) {
    const float scale = 1.0F / static_cast<float>(1 << index);
    return bilinear(levels_[static_cast<std::size_t>(index)], centre.x() * scale - 0.5F,
                    centre.y() * scale - 0.5F);
  };
  const float blend = level - static_cast<float>(fine);
  const Eigen::Array3f fine_color = at(fine);
  if (blend < 1e-3F || fine == top) return fine_color;
  return fine_color * (1.0F - blend) + at(fine + 1) * blend;
}

Eigen::Array3f MipTexture::sample(const TextureFootprint& footprint) const {
  const float length = footprint.major.norm();
  const float minor = std::max(footprint.minor, 1.0F);
  const int probes =
      std::clamp(static_cast<int>(std::ceil(length / (1.5F * minor))), 1, kMaxProbes);
  const float level = approximateLog2(std::max(minor, length / static_cast<float>(probes)));
  if (probes == 1) return probe(footprint.centre, level);
  Eigen::Array3f sum = Eigen::Array3f::Zero();
  for (int i = 0; i < probes; ++i) {
    const float offset = (static_cast<float>(i) + 0.5F) / static_cast<float>(probes) - 0.5F;
    sum += probe(footprint.centre + offset * footprint.major, level);
  }
  return sum / static_cast<float>(probes);
}

Eigen::Array3f MipTexture::sampleFinest(const Eigen::Vector2f& centre) const {
  return bilinear(levels_.front(), centre.x() - 0.5F, centre.y() - 0.5F);
}

}  // namespace planecloud_slam

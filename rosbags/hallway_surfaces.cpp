// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/rosbags/hallway_surfaces.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "planecloud_slam/rosbags/seeded_random.h"

namespace planecloud {
namespace {

constexpr int kSurfaceSide = 512;  // [texel]
constexpr int kPosterSide = 256;   // [texel]

/// Doubles a repeating image with the (1 3 3 1)/4 spline kernel, which leaves no grid pattern.
Image<float> doubled(const Image<float>& coarse) {
  const int side = coarse.width();
  const int mask = side - 1;
  Image<float> fine(2 * side, 2 * side);
  for (int y = 0; y < fine.height(); ++y) {
    const int near_y = y / 2;
    const int far_y = (near_y + ((y & 1) != 0 ? 1 : -1)) & mask;
    for (int x = 0; x < fine.width(); ++x) {
      const int near_x = x / 2;
      const int far_x = (near_x + ((x & 1) != 0 ? 1 : -1)) & mask;
      fine(x, y) = 0.5625F * coarse(near_x, near_y) + 0.1875F * coarse(far_x, near_y) +
                   0.1875F * coarse(near_x, far_y) + 0.0625F * coarse(far_x, far_y);
    }
  }
  return fine;
}

/// Repeating noise with a band per octave: `strength(wavelength)` is the deviation that the band
/// with blobs of `wavelength` texels adds.
Image<float> multiScaleNoise(std::uint64_t seed, int side,
                             const std::function<double(double)>& strength) {
  SeededRandom random(seed);
  Image<float> noise(2, 2);
  while (true) {
    const double wavelength = 2.0 * side / noise.width();
    const auto deviation = static_cast<float>(strength(wavelength));
    for (float& value : noise) value += deviation * static_cast<float>(random.normal());
    if (noise.width() == side) return noise;
    noise = doubled(noise);
  }
}

std::uint8_t toByte(double value) {
  return static_cast<std::uint8_t>(std::clamp(std::lround(value), 0L, 255L));
}

Rgb8 greyLevel(double value) {
  const std::uint8_t level = toByte(value);
  return {level, level, level};
}

Modulation fromNoise(const Image<float>& modulation) {
  Image<std::uint8_t> pixels(modulation.width(), modulation.height());
  std::transform(modulation.begin(), modulation.end(), pixels.begin(),
                 [](float value) { return toByte(128.0 + value); });
  return Modulation(std::move(pixels));
}

struct Rectangle {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;
};

void fill(Image<Rgb8>& image, const Rectangle& where, const Rgb8& color) {
  for (int y = std::max(where.y, 0); y < std::min(where.y + where.height, image.height()); ++y) {
    for (int x = std::max(where.x, 0); x < std::min(where.x + where.width, image.width()); ++x) {
      image(x, y) = color;
    }
  }
}

Rgb8 randomColor(SeededRandom& random, double low, double high) {
  return {toByte(random.uniform(low, high)), toByte(random.uniform(low, high)),
          toByte(random.uniform(low, high))};
}

/// Lines of words in dark ink.
void printText(Image<Rgb8>& image, const Rectangle& where, SeededRandom& random) {
  const int line = random.integer(4, 8);
  const Rgb8 ink = greyLevel(random.uniform(20.0, 80.0));
  for (int y = where.y; y + line <= where.y + where.height; y += line + line / 2 + 2) {
    const int end = where.x + static_cast<int>(where.width * random.uniform(0.5, 1.0));
    for (int x = where.x; x < end;) {
      const int word = random.integer(2 * line / 2, 4 * line);
      fill(image, {x, y, std::min(word, end - x), line}, ink);
      x += word + random.integer(2, line);
    }
  }
}

/// A picture: blotches in two colours with discs on them.
void printPicture(Image<Rgb8>& image, const Rectangle& where, SeededRandom& random) {
  const Image<float> blotches = multiScaleNoise(
      random.bits(), 128, [](double wavelength) { return wavelength > 8 ? 0.35 : 0.08; });
  const Rgb8 dark = randomColor(random, 10.0, 140.0);
  const Rgb8 light = randomColor(random, 110.0, 250.0);
  const double radius = random.uniform(0.15, 0.45) * std::min(where.width, where.height);
  const double centre_x = where.x + random.uniform(0.3, 0.7) * where.width;
  const double centre_y = where.y + random.uniform(0.3, 0.7) * where.height;
  for (int y = where.y; y < where.y + where.height; ++y) {
    for (int x = where.x; x < where.x + where.width; ++x) {
      const bool disc = std::hypot(x - centre_x, y - centre_y) < radius;
      double mix = std::clamp(0.5 + double{blotches(x & 127, y & 127)}, 0.0, 1.0);
      if (disc) mix = 1.0 - mix;
      const auto blend = [&](int a, int b) { return toByte(a + mix * (b - a)); };
      image(x, y) = {blend(dark.r, light.r), blend(dark.g, light.g), blend(dark.b, light.b)};
    }
  }
}

}  // namespace

Modulation makePaintTexture(std::uint64_t seed) {
  return fromNoise(multiScaleNoise(seed, kSurfaceSide, [](double wavelength) {
    return wavelength < 6.0 ? 22.0 : wavelength < 40.0 ? 14.0 : 9.0;
  }));
}

Modulation makeBlotchTexture(std::uint64_t seed) {
  return fromNoise(multiScaleNoise(seed, kSurfaceSide, [](double wavelength) {
    return wavelength < 6.0 ? 2.0 : wavelength < 24.0 ? 14.0 : 20.0;
  }));
}

Modulation makeFloorTexture(std::uint64_t seed) {
  Image<float> floor = multiScaleNoise(seed, kSurfaceSide, [](double wavelength) {
    return wavelength < 10.0 ? 26.0 : wavelength < 40.0 ? 10.0 : 6.0;
  });
  constexpr int kTile = kSurfaceSide / 4;
  for (int y = 0; y < floor.height(); ++y) {
    for (int x = 0; x < floor.width(); ++x) {
      const auto tile = static_cast<std::uint64_t>((y / kTile) * 4 + x / kTile);
      floor(x, y) += static_cast<float>(hashOf(seed, 1, tile) % 25) - 12.0F;
      if (x % kTile < 2 || y % kTile < 2) floor(x, y) = -70.0F;
    }
  }
  return fromNoise(floor);
}

Modulation makeCeilingTexture(std::uint64_t seed) {
  Image<float> ceiling = multiScaleNoise(
      seed, kSurfaceSide, [](double wavelength) { return wavelength < 10.0 ? 12.0 : 4.0; });
  SeededRandom random(hashOf(seed, 1));
  for (int hole = 0; hole < 2500; ++hole) {
    const int x = random.integer(0, kSurfaceSide - 1);
    const int y = random.integer(0, kSurfaceSide - 1);
    ceiling(x, y) -= static_cast<float>(random.uniform(30.0, 90.0));
  }
  for (int y = 0; y < ceiling.height(); ++y) {
    for (int x = 0; x < ceiling.width(); ++x) {
      if (x % (kSurfaceSide / 2) < 5 || y % (kSurfaceSide / 2) < 5) ceiling(x, y) = -60.0F;
    }
  }
  return fromNoise(ceiling);
}

Modulation makeWoodTexture(std::uint64_t seed) {
  const Image<float> bands = multiScaleNoise(
      seed, kSurfaceSide, [](double wavelength) { return wavelength < 12.0 ? 22.0 : 16.0; });
  Image<float> wood(kSurfaceSide, kSurfaceSide);
  for (int y = 0; y < wood.height(); ++y) {
    for (int x = 0; x < wood.width(); ++x) wood(x, y) = bands(x, y / 16);
  }
  return fromNoise(wood);
}

Modulation makeCardboardTexture(std::uint64_t seed) {
  Image<float> board = multiScaleNoise(
      seed, kSurfaceSide, [](double wavelength) { return wavelength < 10.0 ? 12.0 : 14.0; });
  SeededRandom random(hashOf(seed, 1));
  const auto print = [&](const Rectangle& where, float ink) {
    for (int y = where.y; y < where.y + where.height; ++y) {
      for (int x = where.x; x < where.x + where.width; ++x) {
        board(x & (kSurfaceSide - 1), y & (kSurfaceSide - 1)) += ink;
      }
    }
  };
  for (int label = 0; label < 10; ++label) {
    print({random.integer(0, kSurfaceSide), random.integer(0, kSurfaceSide),
           random.integer(20, 140), random.integer(10, 80)},
          static_cast<float>(random.chance(0.5) ? random.uniform(30.0, 80.0)
                                                : random.uniform(-100.0, -40.0)));
  }
  print({0, random.integer(0, kSurfaceSide), kSurfaceSide, 24}, 35.0F);
  return fromNoise(board);
}

Picture makePosterTexture(std::uint64_t seed) {
  SeededRandom random(seed);
  Image<Rgb8> poster(kPosterSide, kPosterSide, randomColor(random, 150.0, 250.0));
  constexpr int kMargin = 12;
  constexpr int kInner = kPosterSide - 2 * kMargin;
  const int title = random.integer(20, 50);
  fill(poster, {kMargin, kMargin, kInner, title}, randomColor(random, 10.0, 230.0));
  const int rows = random.integer(1, 3);
  const int columns = random.integer(1, 2);
  const int cell_height = (kInner - title) / rows;
  const int cell_width = kInner / columns;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const Rectangle cell{kMargin + column * cell_width + 5,
                           kMargin + title + row * cell_height + 5, cell_width - 10,
                           cell_height - 10};
      if (random.chance(0.55)) {
        printPicture(poster, cell, random);
      } else {
        printText(poster, cell, random);
      }
    }
  }
  return Picture(std::move(poster));
}

Picture makeWindowTexture(std::uint64_t seed) {
  SeededRandom random(seed);
  Image<Rgb8> view(kPosterSide, kPosterSide);
  for (int y = 0; y < kPosterSide; ++y) {
    fill(view, {0, y, kPosterSide, 1}, {toByte(205 + 0.1 * y), toByte(215 + 0.08 * y), 242});
  }
  for (int roof = 0; roof < 7; ++roof) {
    const int top = random.integer(150, 220);
    fill(view, {random.integer(-20, kPosterSide), top, random.integer(30, 80), kPosterSide - top},
         randomColor(random, 90.0, 170.0));
  }
  return Picture(std::move(view));
}

}  // namespace planecloud

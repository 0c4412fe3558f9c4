// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/rosbags/astra_sensor_model.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "planecloud_slam/rosbags/seeded_random.h"

namespace planecloud {
namespace {

constexpr float kNoAnswer = std::numeric_limits<float>::quiet_NaN();

/// Streams of random numbers of one frame.
enum Stream : std::uint64_t { kDisparityStream = 1, kLumaStream, kChromaStream, kEdgeStream };

std::uint64_t streamOf(const SensorFrame& frame, Stream stream) {
  return hashOf(frame.seed, frame.index, stream);
}

/// Running sums over `width` neighbours of the columns or rows, in integers: exact everywhere.
/// `image` has a margin, which is used up by `width - 1`.
Image<std::int32_t> boxSum(const Image<std::int32_t>& image, int width) {
  Image<std::int32_t> rows(image.width() - width + 1, image.height());
  for (int y = 0; y < rows.height(); ++y) {
    const std::int32_t* source = image.row(y);
    std::int32_t sum = 0;
    for (int x = 0; x < width - 1; ++x) sum += source[x];
    for (int x = 0; x < rows.width(); ++x) {
      sum += source[x + width - 1];
      rows(x, y) = sum;
      sum -= source[x];
    }
  }
  Image<std::int32_t> sums(rows.width(), rows.height() - width + 1);
  for (int y = 0; y < sums.height(); ++y) {
    for (int k = 0; k < width; ++k) {
      const std::int32_t* source = rows.row(y + k);
      std::int32_t* target = sums.row(y);
      for (int x = 0; x < sums.width(); ++x) target[x] += source[x];
    }
  }
  return sums;
}

/// Normal noise of deviation 1, correlated over about five pixels: white noise summed over 5 x 5
/// and again over 3 x 3 pixels, as a block matcher averages over its window.
Image<float> correlatedNoise(std::uint64_t stream, int width, int height) {
  constexpr int kMargin = 6;
  Image<std::int32_t> white(width + kMargin, height + kMargin);
  for (int y = 0; y < white.height(); ++y) {
    for (int x = 0; x < white.width(); ++x) {
      const std::uint64_t bits = mixBits(stream + static_cast<std::uint64_t>(y * 8192 + x));
      white(x, y) = (bellShaped(bits) - static_cast<std::int32_t>(kBellMean)) >> 4;
    }
  }
  const Image<std::int32_t> sums = boxSum(boxSum(white, 5), 3);
  // One axis weights its seven inputs 1 2 3 3 3 2 1: squares sum to 37, in two axes to 37^2.
  const float scale = 16.0F / (kBellDeviation * 37.0F);
  Image<float> noise(width, height);
  std::transform(sums.begin(), sums.end(), noise.begin(),
                 [&](std::int32_t sum) { return scale * static_cast<float>(sum); });
  return noise;
}

std::uint8_t toByte(float value) {
  return static_cast<std::uint8_t>(std::clamp(value, 0.0F, 255.0F) + 0.5F);
}

}  // namespace

Image<float> AstraSensorModel::noisyDisparity(const RenderedView& view,
                                              const SensorFrame& frame) const {
  const auto scale = static_cast<float>(options_.focal_length * options_.baseline);
  const auto near_noise = static_cast<float>(options_.disparity_noise);
  const auto far_noise = static_cast<float>(options_.far_disparity_noise);
  const auto max_depth = static_cast<float>(options_.max_depth);
  const auto grazing = static_cast<float>(options_.grazing_cosine);
  const Image<float> noise =
      correlatedNoise(streamOf(frame, kDisparityStream), view.depth.width(), view.depth.height());
  Image<float> disparity(view.depth.width(), view.depth.height(), kNoAnswer);
  for (std::size_t i = 0; i < disparity.size(); ++i) {
    const float depth = view.depth.begin()[i];
    const float cosine = view.incidence.begin()[i];
    // The noise also decides which grazing pixels answer, so that they come in clumps.
    if (cosine <= grazing * std::max(0.4F, 1.0F + 0.35F * noise.begin()[i])) continue;
    if (!(depth >= static_cast<float>(options_.min_depth) && depth <= max_depth)) continue;
    const float weak = std::max(depth / max_depth, 1.0F - 2.0F * cosine);
    const float deviation = near_noise + (far_noise - near_noise) * weak * weak;
    disparity.begin()[i] = scale / depth + deviation * noise.begin()[i];
  }
  return disparity;
}

void AstraSensorModel::dropShadows(const RenderedView& view, Image<float>& disparity) const {
  const auto scale = static_cast<float>(options_.focal_length * options_.baseline) *
                     static_cast<float>(view.depth.width()) / 640.0F;
  for (int y = 0; y < view.depth.height(); ++y) {
    // A point is lit unless something further right stands between it and the projector.
    float lit_until = std::numeric_limits<float>::infinity();
    for (int x = view.depth.width() - 1; x >= 0; --x) {
      const float depth = view.depth(x, y);
      if (!(depth > 0.0F)) continue;
      const float projector_x = static_cast<float>(x) - scale / depth;
      if (projector_x > lit_until + 0.5F) disparity(x, y) = kNoAnswer;
      lit_until = std::min(lit_until, projector_x);
    }
  }
}

void AstraSensorModel::dropEdges(const RenderedView& view, const SensorFrame& frame,
                                 Image<float>& disparity) const {
  constexpr float kJump = 0.75F;  // of disparity within the matching window [px]
  const auto scale = static_cast<float>(options_.focal_length * options_.baseline);
  const std::uint64_t stream = streamOf(frame, kEdgeStream);
  const Image<float>& depth = view.depth;
  for (int y = 1; y + 1 < depth.height(); ++y) {
    for (int x = 1; x + 1 < depth.width(); ++x) {
      const float across =
          scale / depth(x - 1, y) - 2.0F * scale / depth(x, y) + scale / depth(x + 1, y);
      const float down =
          scale / depth(x, y - 1) - 2.0F * scale / depth(x, y) + scale / depth(x, y + 1);
      if (std::abs(across) < kJump && std::abs(down) < kJump) continue;
      const std::uint64_t bits = mixBits(stream + static_cast<std::uint64_t>(y * 8192 + x));
      // Two of three edge pixels are lost, and often a neighbour with them.
      if (bits % 3 != 0) disparity(x, y) = kNoAnswer;
      if ((bits >> 8) % 2 == 0) disparity(x - 1, y) = kNoAnswer;
      if ((bits >> 16) % 2 == 0) disparity(x, y - 1) = kNoAnswer;
    }
  }
}

Image<std::uint16_t> AstraSensorModel::senseDepth(const RenderedView& view,
                                                  const SensorFrame& frame) const {
  Image<float> disparity = noisyDisparity(view, frame);
  dropShadows(view, disparity);
  dropEdges(view, frame, disparity);
  const auto step = static_cast<float>(options_.disparity_step);
  const auto millimetres = static_cast<float>(1e3 * options_.focal_length * options_.baseline);
  Image<std::uint16_t> depth(disparity.width(), disparity.height());
  std::transform(disparity.begin(), disparity.end(), depth.begin(), [&](float value) {
    if (!(value > 0.0F)) return std::uint16_t{0};
    const float quantised = step * std::floor(value / step + 0.5F);
    const float z = millimetres / std::max(quantised, step);
    const bool in_range = z >= 1e3F * static_cast<float>(options_.min_depth) &&
                          z <= 1e3F * static_cast<float>(options_.max_depth);
    return in_range ? static_cast<std::uint16_t>(z + 0.5F) : std::uint16_t{0};
  });
  return depth;
}

double AstraSensorModel::exposure(const SensorFrame& frame) const {
  SeededRandom random(hashOf(frame.seed, 0xe0));
  double drift = 0.0;
  for (const double period : {41.0, 17.0}) {
    drift +=
        0.5 *
        std::sin(2.0 * M_PI *
                 (frame.time / (period * random.uniform(0.8, 1.2)) + random.uniform(0.0, 1.0)));
  }
  return 1.0 + options_.exposure_drift * drift;
}

Image<Rgb8> AstraSensorModel::senseColor(const RenderedView& view, const SensorFrame& frame) const {
  constexpr int kBlock = 8;  // of chroma noise, as webcam compression leaves it [px]
  const auto gain = static_cast<float>(exposure(frame));
  const auto deviation = static_cast<float>(options_.color_noise) / kBellDeviation;
  const std::uint64_t luma_stream = streamOf(frame, kLumaStream);
  const std::uint64_t chroma_stream = streamOf(frame, kChromaStream);
  Image<Rgb8> color(view.color.width(), view.color.height());
  for (int y = 0; y < color.height(); ++y) {
    for (int x = 0; x < color.width(); ++x) {
      const Eigen::Array3f ideal = gain * view.color(x, y);
      const auto pixel = static_cast<std::uint64_t>(y * 8192 + x);
      const auto block = static_cast<std::uint64_t>((y / kBlock) * 8192 + x / kBlock);
      // Shot noise: half the variance at mid grey comes from the light itself.
      const float shot = std::sqrt(0.5F + ideal.y() / 256.0F);
      const float luma = deviation * shot *
                         (static_cast<float>(bellShaped(mixBits(luma_stream + pixel))) - kBellMean);
      const std::uint64_t chroma = mixBits(chroma_stream + block);
      const float red = static_cast<float>(chroma & 0xff) / 127.5F - 1.0F;
      const float blue = static_cast<float>((chroma >> 8) & 0xff) / 127.5F - 1.0F;
      color(x, y) = {toByte(ideal.x() + luma + red), toByte(ideal.y() + luma),
                     toByte(ideal.z() + luma + blue)};
    }
  }
  return color;
}

Image<std::uint16_t> toMillimetres(const Image<float>& depth) {
  Image<std::uint16_t> millimetres(depth.width(), depth.height());
  std::transform(depth.begin(), depth.end(), millimetres.begin(), [](float z) {
    return z > 0.0F && z < 65.0F ? static_cast<std::uint16_t>(1e3F * z + 0.5F) : std::uint16_t{0};
  });
  return millimetres;
}

Image<Rgb8> toRgb8(const Image<Eigen::Array3f>& color) {
  Image<Rgb8> pixels(color.width(), color.height());
  std::transform(color.begin(), color.end(), pixels.begin(), [](const Eigen::Array3f& c) {
    return Rgb8{toByte(c.x()), toByte(c.y()), toByte(c.z())};
  });
  return pixels;
}

}  // namespace planecloud

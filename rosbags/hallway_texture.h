// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "planecloud_slam/plane_fit/image_view.h"
#include "planecloud_slam/plane_fit/rgb8.h"

namespace planecloud {

/// The part of a surface that one pixel sees, in texels: its centre and its longest extent.
struct TextureFootprint {
  Eigen::Vector2f centre = Eigen::Vector2f::Zero();  ///< [texel]
  Eigen::Vector2f major = Eigen::Vector2f::Zero();   ///< the long axis, whole length [texel]
  float minor = 1.0F;                                ///< length of the short axis [texel]
};

/// A texture that repeats in both directions, with its pyramid of averages, so that a distant or
/// slanted surface shows what a real camera would average instead of aliasing. `Texel` is
/// std::uint8_t (grey) or Rgb8.
template <typename Texel>
class MipTexture {
 public:
  /// What a sample is: float or Eigen::Array3f (red, green, blue), 0..255.
  using Value = std::conditional_t<std::is_same_v<Texel, Rgb8>, Eigen::Array3f, float>;

  /// Throws std::invalid_argument unless `finest` is square with a power of two as its side.
  explicit MipTexture(Image<Texel> finest);

  /// Side of the finest level [texel].
  [[nodiscard]] int side() const { return levels_.front().width(); }
  /// Mean over the footprint: up to three trilinear probes along its long axis.
  [[nodiscard]] Value sample(const TextureFootprint& footprint) const;
  /// Bilinear value of the finest level.
  [[nodiscard]] Value sampleFinest(const Eigen::Vector2f& centre) const;

 private:
  [[nodiscard]] Value probe(const Eigen::Vector2f& centre, float level) const;

  std::vector<Image<Texel>> levels_;
};

extern template class MipTexture<std::uint8_t>;
extern template class MipTexture<Rgb8>;

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "planecloud_slam/plane_fit/image_view.h"
#include "planecloud_slam/rosbags/rgb8.h"

namespace planecloud_slam {

/// The part of a surface that one pixel sees, in texels: its centre and its longest extent.
struct TextureFootprint {
  Eigen::Vector2f centre = Eigen::Vector2f::Zero();  ///< [texel]
  Eigen::Vector2f major = Eigen::Vector2f::Zero();   ///< the long axis, whole length [texel]
  float minor = 1.0F;                                ///< length of the short axis [texel]
};

/// A texture that repeats in both directions, with its pyramid of averages, so that a distant or
/// slanted surface shows what a real camera would average instead of aliasing.
class MipTexture {
 public:
  /// Throws std::invalid_argument unless `finest` is square with a power of two as its side.
  explicit MipTexture(Image<Rgb8> finest);

  /// Side of the finest level [texel].
  [[nodiscard]] int side() const { return levels_.front().width(); }
  /// Mean colour over the footprint, 0..255: up to four trilinear probes along its long axis.
  [[nodiscard]] Eigen::Array3f sample(const TextureFootprint& footprint) const;
  /// Bilinear colour of the finest level, 0..255.
  [[nodiscard]] Eigen::Array3f sampleFinest(const Eigen::Vector2f& centre) const;

 private:
  [[nodiscard]] Eigen::Array3f probe(const Eigen::Vector2f& centre, float level) const;

  std::vector<Image<Rgb8>> levels_;
};

}  // namespace planecloud_slam

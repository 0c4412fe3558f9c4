// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>

#include "planecloud_slam/plane_fit/image_view.h"
#include "planecloud_slam/plane_fit/keyframe.h"
#include "planecloud_slam/plane_fit/option_fields.h"
#include "planecloud_slam/plane_fit/rgb8.h"

namespace planecloud {

/// What of a keyframe's image travels.
enum class TextureFormat {
  kNone,
  kGrey,
  kColor,
};
[[nodiscard]] std::string toString(TextureFormat format);
/// Throws std::invalid_argument naming the choices.
void fromString(const std::string& text, TextureFormat& format);

/// Options of `encodeTexture`, keys below `texture/`.
struct TextureOptions {
  TextureFormat format = TextureFormat::kGrey;
  double scale = 0.125;  ///< side of the texture by that of the image, [0.02, 1]
  int quality = 40;      ///< of the JPEG, [5, 100]
  /// Most of a keyframe's byte budget that texture takes from its planes, [0, 1].
  double max_share = 0.4;

  template <typename Self, typename Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("format", self.format);
    visit("scale", self.scale);
    visit("quality", self.quality);
    visit("max_share", self.max_share);
  }
  /// Throws std::invalid_argument naming key, value and range.
  void check() const;
};

/// The image as a JPEG of at most `most_bytes`, scaled down by areas: colour where colour is wanted
/// and there, else grey. Where it does not fit, first quality, then scale give way; no texture when
/// even the smallest does not fit or none is wanted. All images are in the keyframe's view; `color`
/// may be empty.
[[nodiscard]] KeyframeTexture encodeTexture(
    ImageView<std::uint8_t> grey, ImageView<Rgb8> color, const TextureOptions& options,
    std::size_t most_bytes = std::numeric_limits<std::size_t>::max());

}  // namespace planecloud

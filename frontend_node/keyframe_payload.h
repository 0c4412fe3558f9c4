// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "planecloud_slam/frontend_node/keyframe_texture.h"
#include "planecloud_slam/plane_fit/fitted_depth.h"
#include "planecloud_slam/plane_fit/image_view.h"
#include "planecloud_slam/plane_fit/keyframe.h"
#include "planecloud_slam/plane_fit/plane_cloud_codec.h"
#include "planecloud_slam/plane_fit/rgb8.h"

namespace planecloud {

/// What makes nearly all bytes of a keyframe.
struct KeyframePayload {
  EncodedPlaneCloud planes;
  KeyframeTexture texture;
  [[nodiscard]] std::size_t bytes() const { return planes.bytes.size() + texture.bytes.size(); }
};

/// The images texture is made of; `color` may be empty.
struct TextureSource {
  ImageView<std::uint8_t> grey;
  ImageView<Rgb8> color;
};

/// How planes and texture are encoded.
struct PayloadOptions {
  CodecOptions codec;  ///< its byte budget counts texture too
  TextureOptions texture;
};

/// Encodes planes (or what else the codec wishes) and texture. Together they keep to the codec's
/// byte budget and to `most_bytes`, the smaller of both: texture takes at most its share, planes
/// have the rest. Throws as `encode` does.
[[nodiscard]] KeyframePayload encodePayload(const FittedDepth& fitted, const TextureSource& images,
                                            const PayloadOptions& options,
                                            std::optional<std::size_t> most_bytes = {});

}  // namespace planecloud

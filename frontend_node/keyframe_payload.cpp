// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/frontend_node/keyframe_payload.h"

#include <algorithm>
#include <utility>

namespace planecloud {
namespace {

constexpr std::size_t kLeastStream = 64;  // CodecOptions::byte_budget

std::optional<std::size_t> tighter(const CodecOptions& codec,
                                   std::optional<std::size_t> most_bytes) {
  if (codec.byte_budget == 0) return most_bytes;
  const auto budget = static_cast<std::size_t>(codec.byte_budget);
  return std::min(budget, most_bytes.value_or(budget));
}

}  // namespace

KeyframePayload encodePayload(const FittedDepth& fitted, const TextureSource& images,
                              const PayloadOptions& options,
                              std::optional<std::size_t> most_bytes) {
  KeyframePayload payload;
  const std::optional<std::size_t> budget = tighter(options.codec, most_bytes);
  if (!budget) {
    payload.planes = encode(fitted, options.codec);
    payload.texture = encodeTexture(images.grey, images.color, options.texture);
    return payload;
  }
  // Planes have what texture may not take, or will not: neither shrinks when the budget grows, so
  // that coverage does not either. Texture has what planes leave.
  KeyframeTexture whole = encodeTexture(images.grey, images.color, options.texture);
  const auto share =
      static_cast<std::size_t>(options.texture.max_share * static_cast<double>(*budget));
  CodecOptions codec = options.codec;
  const std::size_t rest = *budget - std::min(share, whole.bytes.size());
  codec.byte_budget = static_cast<int>(std::max(kLeastStream, rest));
  payload.planes = encode(fitted, codec);
  const std::size_t planes = std::min(*budget, payload.planes.bytes.size());
  const std::size_t left = std::min(share, *budget - planes);
  payload.texture = whole.bytes.size() <= left
                        ? std::move(whole)
                        : encodeTexture(images.grey, images.color, options.texture, left);
  return payload;
}

}  // namespace planecloud

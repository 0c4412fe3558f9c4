// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "planecloud_slam/rosbags/hallway_texture.h"

namespace planecloud {

using Modulation = MipTexture<std::uint8_t>;
using Picture = MipTexture<Rgb8>;

/// The surfaces of the built-in world, all by seed. The grey ones modulate around 128 and are
/// scaled by their material's contrast and colour.

/// Roller-painted plaster: fine grain and soft blotches.
[[nodiscard]] Modulation makePaintTexture(std::uint64_t seed);
/// Speckled vinyl in 4 x 4 tiles with seams.
[[nodiscard]] Modulation makeFloorTexture(std::uint64_t seed);
/// 2 x 2 mineral-fibre ceiling boards with grooves and pinholes.
[[nodiscard]] Modulation makeCeilingTexture(std::uint64_t seed);
/// Grain along the second axis.
[[nodiscard]] Modulation makeWoodTexture(std::uint64_t seed);
/// Packing cardboard: flutes, blotches, tape and prints.
[[nodiscard]] Modulation makeCardboardTexture(std::uint64_t seed);
/// Blotches of all sizes up to the whole texture, for slow changes over metres.
[[nodiscard]] Modulation makeBlotchTexture(std::uint64_t seed);
/// A poster or notice in colour, different for each seed: title, text lines, pictures, a margin.
[[nodiscard]] Picture makePosterTexture(std::uint64_t seed);
/// What is seen through a window: a bright sky over roofs.
[[nodiscard]] Picture makeWindowTexture(std::uint64_t seed);

}  // namespace planecloud

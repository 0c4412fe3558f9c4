// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "planecloud_slam/plane_fit/image_view.h"

namespace planecloud_slam {

/// A compact binary description of what a keyframe looks like, for recognising places without any
/// position: randomised ferns (Glocker et al., TVCG 2015) on a small blurred image. Each fern is
/// a few binary tests on brightness and on depth; every test compares two places of the same
/// image, so exposure does not matter. First byte: version; under 300 bytes in all.
///
/// `grey` [0..255] and `depth` [m, NaN or <= 0: none] show the same view; sizes may differ. An
/// empty or all-invalid depth is allowed. Returns no bytes when `grey` is empty.
[[nodiscard]] std::vector<std::uint8_t> makeAppearanceDescriptor(ImageView<std::uint8_t> grey,
                                                                 ImageView<float> depth);

/// Share of ferns that differ, [0, 1], among those known in both: about 0.1-0.35 for views of one
/// place a step apart, 0.45 and more for different places of one building. None when either
/// descriptor is empty, malformed or of another version, or when too few ferns know their answer in
/// both.
[[nodiscard]] std::optional<double> appearanceDissimilarity(const std::vector<std::uint8_t>& a,
                                                            const std::vector<std::uint8_t>& b);

}  // namespace planecloud_slam

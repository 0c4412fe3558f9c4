// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "planecloud_slam/icap/view_search.h"

namespace planecloud {

/// bestTiles and lookUpTiles by vector instructions, for cameras without lens distortion; only
/// there with Highway.
[[nodiscard]] std::vector<std::int32_t> bestTilesVector(const TileView& view,
                                                        const MovedPatches& patches,
                                                        const ViewGates& gates);
[[nodiscard]] SeenTiles lookUpTilesVector(const TileView& view, const MovedPatches& patches);

}  // namespace planecloud

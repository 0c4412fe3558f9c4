// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "planecloud_slam/plane_fit/plane_cloud.h"
#include "planecloud_slam/plane_fit/tile_kernels.h"

namespace planecloud {

/// The sums of a rectangle without holes, about its first pixel.
[[nodiscard]] PositionSums allPositions(const TileRect& rect);

/// Sums of the tangents over pixels of a node in which they are affine.
[[nodiscard]] TangentSums sumTangents(const PositionSums& positions, const LocalTangents& tangents);

/// The regression of a node on pixel positions, whose scatter tells exactly whether pixels span a
/// direction, and from there to tangents; `rect` has the node's size.
[[nodiscard]] NodePlane regressPositions(const PositionSums& positions, const DepthSums& sums,
                                         const LocalTangents& tangents, const TileRect& rect);

}  // namespace planecloud

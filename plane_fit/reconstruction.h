// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "planecloud_slam/plane_fit/camera.h"
#include "planecloud_slam/plane_fit/plane_cloud.h"

namespace planecloud {

/// The depth image [m] that `cloud` stands for, height x width of its camera; NaN where no tile
/// lies or, with a mask, no depth was. Throws std::invalid_argument when `camera` is not the
/// cloud's.
[[nodiscard]] Image<float> reconstructDepth(const PlaneCloud& cloud, const Camera& camera);

/// Points [m] of the optical frame on the tiles, one for every `step`-th pixel of the image in both
/// directions ((0, 0) is the first), tile after tile. Throws as above and for step < 1.
[[nodiscard]] std::vector<Eigen::Vector3f> reconstructPoints(const PlaneCloud& cloud,
                                                             const Camera& camera, int step = 1);

/// Corners [m] of the tile's patch in the optical frame, clockwise in the image from the upper
/// left: at the outer edges of its pixels, so that neighbouring patches meet. Lens distortion is
/// undone; where it cannot be (the very border), the pinhole's ray is taken. None when a corner's
/// ray does not hit the plane within a depth of `max_depth` [m].
[[nodiscard]] std::optional<std::array<Eigen::Vector3d, 4>> tileCorners(
    const PlanarTile& tile, const CameraIntrinsics& camera, double max_depth = 20.0);

}  // namespace planecloud

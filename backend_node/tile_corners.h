// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "planecloud_slam/plane_fit/camera.h"
#include "planecloud_slam/plane_fit/plane_cloud.h"

namespace planecloud_slam {

/// Corners of a tile on its plane [m, optical frame], in the order upper left, lower left, lower
/// right, upper right: counter-clockwise seen from the camera. Neighbouring tiles share borders.
/// None when a corner's ray does not hit the plane within `max_depth` [m].
[[nodiscard]] std::optional<std::array<Eigen::Vector3d, 4>> tileCorners(const Camera& camera,
                                                                        const PlanarTile& tile,
                                                                        double max_depth = 20.0);

}  // namespace planecloud_slam

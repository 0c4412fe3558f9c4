// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "planecloud_slam/plane_fit/plane_cloud.h"

namespace planecloud {

/// The unit normal [-] of the floor in the camera's frame, pointing up: the area-weighted mean of
/// the tiles below the camera that face `up_camera` (unit) within `max_tilt` [rad]. None when they
/// are too few square metres to be a floor or no common plane.
[[nodiscard]] std::optional<Eigen::Vector3d> findFloorNormal(const PlaneCloud& planes,
                                                             const Eigen::Vector3d& up_camera,
                                                             double max_tilt);

/// The smallest rotation that turns `from` to `to` (both unit).
[[nodiscard]] Eigen::Isometry3d rotationBetween(const Eigen::Vector3d& from,
                                                const Eigen::Vector3d& to);

}  // namespace planecloud

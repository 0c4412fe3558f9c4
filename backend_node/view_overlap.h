// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include "planecloud_slam/backend_node/view_sketch.h"

namespace planecloud {

/// Share of `source`'s samples that fall into `target`'s image and face its camera, and the other
/// way round: the smaller of both, [0, 1]. Ignores occlusion and lens distortion: a cheap
/// prediction of whether two keyframes can be aligned.
[[nodiscard]] double mutualViewOverlap(const ViewSketch& target, const ViewSketch& source,
                                       const Eigen::Isometry3d& T_target_source);

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include "planecloud_slam/icap/alignment_steps.h"
#include "planecloud_slam/icap/icap_options.h"
#include "planecloud_slam/icap/plane_set.h"

namespace planecloud {

/// Gauss-Newton on plane distances and normals from coarse to fine gates. Starts again elsewhere
/// when the views do not support the answer, slides along the direction the planes know least to
/// where the views support each other most, and keeps the guess along what is not observed and no
/// edge tells.
[[nodiscard]] AlignmentProgress alignRobustly(const PlaneSet& target, const PlaneSet& source,
                                              const Eigen::Isometry3d& T_target_source_guess,
                                              const IcapOptions& options);

}  // namespace planecloud

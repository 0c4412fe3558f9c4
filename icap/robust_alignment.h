// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "planecloud_slam/icap/icap_options.h"
#include "planecloud_slam/icap/patch_matcher.h"
#include "planecloud_slam/icap/plane_normal_equations.h"
#include "planecloud_slam/icap/plane_set.h"

namespace planecloud {

/// Errors of neighbouring pieces are alike (one tile, one disparity step, one lens), so that many
/// residuals say what one would; found by normalised errors on rendered and real pairs.
constexpr double kCorrelatedResiduals = 15.0;

/// Where the iterations of an alignment stand.
struct AlignmentProgress {
  Eigen::Isometry3d T_target_source = Eigen::Isometry3d::Identity();
  std::vector<PatchMatch> matches;  ///< of the last iteration
  PlaneNormalEquations system;      ///< likewise
  Observability observability;      ///< of `system`
  double last_step = 0.0;           ///< norm of the last twist [m, rad]
  double support = 0.0;  ///< of what each view should see of the other, the share it does see
  int iterations = 0;
  bool enough = false;  ///< matches for a transform
};

/// Gauss-Newton on plane distances and normals from coarse to fine gates. Starts again elsewhere
/// when the views do not support the answer, keeps the guess along what is not observed, and slides
/// along the direction the planes know least to where the views support each other most.
[[nodiscard]] AlignmentProgress alignRobustly(const PlaneSet& target, const PlaneSet& source,
                                              const Eigen::Isometry3d& T_target_source_guess,
                                              const IcapOptions& options);

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "planecloud_slam/icap/icap_options.h"
#include "planecloud_slam/icap/plane_set.h"
#include "planecloud_slam/plane_fit/se3.h"

namespace planecloud {

enum class IcapStatus {
  kConverged,     ///< settled, all six directions observed
  kDegenerate,    ///< settled, but no better than the guess along `unobserved`: use the rest
  kTooFewPlanes,  ///< not enough matches for a transform; the result is the guess
  kDiverged,      ///< left the neighbourhood of the guess or never settled: do not use
};

[[nodiscard]] std::string toString(IcapStatus status);

/// Where two plane clouds lie to each other.
struct IcapResult {
  Eigen::Isometry3d T_target_source = Eigen::Isometry3d::Identity();
  IcapStatus status = IcapStatus::kTooFewPlanes;
  int iterations = 0;
  int inliers = 0;       ///< matches within the final gates
  double overlap = 0.0;  ///< of the source tiles the target should see, those that agree, [0, 1]
  /// RMS distance of inlier centroids to their matched planes [m]. Validates nothing by itself.
  double rms_algebraic_error = 0.0;
  /// At the source's tangent space, order (translation, rotation), see se3.h [1/m^2, 1/rad^2].
  /// Exactly zero along `unobserved`; all zero for kTooFewPlanes and kDiverged.
  Matrix6d information = Matrix6d::Zero();
  /// Orthonormal basis of the null space of `information` (twists at the source).
  std::vector<Vector6d> unobserved;
};

/// Aligns `source` to `target`, starting at `T_target_source_guess` (paper sec. 3.4, Algorithm 2).
/// Deterministic. Throws std::invalid_argument when `options` fail their check.
[[nodiscard]] IcapResult icap(const PlaneSet& target, const PlaneSet& source,
                              const Eigen::Isometry3d& T_target_source_guess,
                              const IcapOptions& options = IcapOptions());

}  // namespace planecloud

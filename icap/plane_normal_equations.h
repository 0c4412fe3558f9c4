// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "planecloud_slam/icap/icap_options.h"
#include "planecloud_slam/icap/patch_matcher.h"
#include "planecloud_slam/plane_fit/se3.h"

namespace planecloud {

/// Errors of neighbouring pieces are alike (one tile, one disparity step, one lens), so that many
/// residuals say what one would; found by normalised errors on rendered and real pairs.
constexpr double kCorrelatedResiduals = 15.0;

/// Gauss-Newton system of matched patches about `T_target_source`, for a twist at the source
/// (T <- T Exp(xi)). Residuals of a match: the source centroid's distance to the target's plane,
/// and the difference of the normals, each in standard deviations, under the Geman-McClure kernel.
struct PlaneNormalEquations {
  Matrix6d hessian = Matrix6d::Zero();
  Vector6d gradient = Vector6d::Zero();
  /// What the errors of the normals alone would make of `hessian` where nothing is observed.
  Matrix6d noise = Matrix6d::Zero();
  double weighted_error = 0.0;    ///< sum of kernel weight x squared normalised plane distance
  double weight = 0.0;            ///< sum of kernel weights
  double squared_distance = 0.0;  ///< sum of squared plane distances [m^2]
};

[[nodiscard]] PlaneNormalEquations buildNormalEquations(const std::vector<PatchMatch>& matches,
                                                        const Eigen::Isometry3d& T_target_source,
                                                        double kernel_width,
                                                        const IcapOptions& options);

/// The twists a system says something about, and those it does not.
struct Observability {
  Eigen::Matrix<double, 6, Eigen::Dynamic> unobserved;  ///< orthonormal basis, 6 x k
  /// Basis of the twists at right angles to the unobserved ones, 6 x (6 - k), orthonormal.
  Eigen::Matrix<double, 6, Eigen::Dynamic> observed;
};

/// Compares the system with what noise alone would make of it (ALGORITHMS: degeneracy is judged
/// against noise): a direction is observed when its curvature exceeds `factor` times the noise's.
[[nodiscard]] Observability analyseObservability(const PlaneNormalEquations& system, double factor);

/// The unit twist whose curvature exceeds the noise's least.
[[nodiscard]] Vector6d leastObserved(const PlaneNormalEquations& system);

/// The Gauss-Newton step within the observed directions; zero along the others.
[[nodiscard]] Vector6d solveObserved(const PlaneNormalEquations& system,
                                     const Observability& observability);

}  // namespace planecloud

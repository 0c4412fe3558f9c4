// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "planecloud_slam/icap/patch_matcher.h"

namespace planecloud {

/// How matches are weighed.
struct MatchWeighing {
  double distance_floor = 0.004;  ///< least standard deviation of a plane distance [m]
  double normal_floor = 0.02;     ///< least standard deviation of a normal [rad]
  double kernel_width = 4.0;      ///< Geman-McClure, in standard deviations [-]
};

/// Sums over matches from which PlaneNormalEquations are made. In the source's axes; p: centroid of
/// the source patch, n: normal of both, the surer one counting more, J = (n, p x n): how a twist
/// changes the distance r between the patches, w: weight of the distance over its variance, s: w
/// times the variance of n, m: normal of the source patch, v: weight of the normals over their
/// variance. Symmetric matrices by their upper halves, row after row.
struct MatchSums {
  std::array<double, 21> hessian{};        ///< w J J^T
  std::array<double, 21> spread_along{};   ///< s J J^T
  std::array<double, 6> gradient{};        ///< w r J, plus v m x (m - normal of the target) below
  double spread = 0.0;                     ///< s
  std::array<double, 3> spread_point{};    ///< s p
  std::array<double, 6> spread_square{};   ///< s p p^T
  double weight = 0.0;                     ///< v
  std::array<double, 6> dyads{};           ///< v m m^T
  double weight_variance = 0.0;            ///< v times the variance: the weight itself
  std::array<double, 6> dyads_variance{};  ///< likewise m m^T
  double weighted_error = 0.0;             ///< kernel weight times r^2 over its variance
  double kernel_weight = 0.0;              ///< of the distances
  double squared_distance = 0.0;           ///< r^2 [m^2]
};

/// Vector instructions chosen at run time where Highway is there (single precision), else as below.
[[nodiscard]] MatchSums sumMatches(const std::vector<PatchMatch>& matches,
                                   const Eigen::Isometry3d& T_source_target,
                                   const MatchWeighing& weighing);

/// The same in double precision without vector instructions: the reference of the tests.
[[nodiscard]] MatchSums sumMatchesScalar(const std::vector<PatchMatch>& matches,
                                         const Eigen::Isometry3d& T_source_target,
                                         const MatchWeighing& weighing);

}  // namespace planecloud

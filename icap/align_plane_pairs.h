// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <vector>

namespace planecloud {

/// Two planes that are taken for the same one, each in its own frame.
struct PlanePair {
  Eigen::Vector4d target = Eigen::Vector4d::Zero();  ///< (a b c d), (a b c) unit [-, m]
  Eigen::Vector4d source = Eigen::Vector4d::Zero();  ///< likewise
  double weight = 1.0;                               ///< >= 0
};

/// Closed-form alignment of plane pairs.
struct PlaneAlignment {
  Eigen::Isometry3d T_target_source = Eigen::Isometry3d::Identity();
  int rotation_rank = 0;     ///< 2 or 3: rotation is determined; less: it is not unique
  int translation_rank = 0;  ///< directions in which the normals determine the translation, 0..3
};

/// The rigid motion that takes the source planes to the target planes in the least-squares sense
/// (paper eq. (6)-(9)). Rotation: SVD of `C = sum w n_target n_source^T` (the paper prints the
/// transpose, which would give the inverse), with the determinant fix. Translation: from
/// `d' = d - n'^T p`, so `N p = d_source - d_target` with the rotated source normals N.
///
/// Directions whose eigenvalue of `N^T N` is at most `observable_share` of the largest are left at
/// zero translation; 0 solves every direction that rounding lets through, as the paper does.
/// Throws std::invalid_argument when there are no pairs, a weight is negative, no weight is
/// positive, or `observable_share` is not in [0, 1).
[[nodiscard]] PlaneAlignment alignPlanePairs(const std::vector<PlanePair>& pairs,
                                             double observable_share = 0.0);

}  // namespace planecloud

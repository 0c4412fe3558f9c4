// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include "planecloud_slam/plane_fit/se3.h"

namespace planecloud {

/// `S` (6 x 6) with `S^T S = information`, also for a semi-definite matrix: rows of directions
/// without information are zero. Eigenvalues are used because Cholesky needs a definite matrix (for
/// those, `llt().matrixU()` would serve as well; `matrixL()` would not).
[[nodiscard]] Matrix6d squareRootInformation(const Matrix6d& information);

/// `information` of a measurement that has, besides its own, an independent error of standard
/// deviations `translation` [m] and `rotation` [rad]. Directions without information keep none.
[[nodiscard]] Matrix6d withErrorFloor(const Matrix6d& information, double translation,
                                      double rotation);

/// The cost of one edge (paper eq. (1), third term): with the measured `T_from_to`,
///
///     r = S Log(T_from_to^-1 T_map_from^-1 T_map_to),   S^T S = information,   6 residuals.
///
/// Poses are perturbed on the right, `T Exp(xi)`, `xi = (translation, rotation)`: see se3.h.
class RelativePoseCost {
 public:
  RelativePoseCost(const Eigen::Isometry3d& T_from_to, const Matrix6d& information);

  /// Residual [-] and its derivatives by the perturbations of both poses, 6 x 6 each.
  struct Linearisation {
    Vector6d residual;
    Matrix6d by_from;
    Matrix6d by_to;
  };

  [[nodiscard]] Vector6d residual(const Eigen::Isometry3d& T_map_from,
                                  const Eigen::Isometry3d& T_map_to) const;
  [[nodiscard]] Linearisation linearise(const Eigen::Isometry3d& T_map_from,
                                        const Eigen::Isometry3d& T_map_to) const;

 private:
  Eigen::Isometry3d T_to_from_;
  Matrix6d square_root_information_;
};

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

/// SE(3) conventions of the whole package.
///
/// A pose `T_target_source` maps points of `source` into `target`. A twist is
/// `xi = (rho, phi)`: three translational [m], then three rotational [rad] components.
/// The error of a measured relative pose is `Log(T_measured^-1 * T_estimate)`, so covariances and
/// information matrices of a relative pose `T_a_b` live in the tangent space at `b`
/// (right perturbation, axes of frame `b`).
namespace planecloud {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// The cross-product matrix: `skew(a) * b == a x b`.
[[nodiscard]] Eigen::Matrix3d skew(const Eigen::Vector3d& a);

/// Rotation of angle `|phi|` [rad] about `phi`.
[[nodiscard]] Eigen::Quaterniond expSo3(const Eigen::Vector3d& phi);

/// The rotation vector [rad], `|phi| <= pi`, of a unit quaternion.
[[nodiscard]] Eigen::Vector3d logSo3(const Eigen::Quaterniond& q);

/// The rigid motion of twist `(rho, phi)`.
[[nodiscard]] Eigen::Isometry3d expSe3(const Vector6d& xi);

/// Inverse of `expSe3`, rotation angle in [0, pi].
[[nodiscard]] Vector6d logSe3(const Eigen::Isometry3d& T);

/// The adjoint: `T * Exp(xi) == Exp(adjoint(T) * xi) * T`.
[[nodiscard]] Matrix6d adjoint(const Eigen::Isometry3d& T);

/// A covariance in the tangent space at `source` as one at `target`.
[[nodiscard]] Matrix6d transformCovariance(const Eigen::Isometry3d& T_target_source,
                                           const Matrix6d& covariance);

/// Rotation angle of `T` [rad], in [0, pi].
[[nodiscard]] double rotationAngle(const Eigen::Isometry3d& T);

/// The information of `T_b_a` when `information` is that of `T_a_b = T`: frame b -> frame a.
[[nodiscard]] Matrix6d invertRelativePoseInformation(const Eigen::Isometry3d& T_a_b,
                                                     const Matrix6d& information);

}  // namespace planecloud

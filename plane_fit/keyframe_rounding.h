// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>

#include "planecloud_slam/plane_fit/camera.h"
#include "planecloud_slam/plane_fit/keyframe.h"
#include "planecloud_slam/plane_fit/se3.h"

/// Keyframes travel in single precision. What rounding does to them is said here once, so that
/// both halves in one process give what they give with a network between them.
namespace planecloud {

/// Translation [m], then rotation vector [rad].
using PackedPose = std::array<float, 6>;
/// Upper triangle of a symmetric 6x6 matrix, row by row.
using PackedInformation = std::array<float, 21>;

[[nodiscard]] PackedPose packPose(const Eigen::Isometry3d& T);
[[nodiscard]] Eigen::Isometry3d unpackPose(const PackedPose& packed);

[[nodiscard]] PackedInformation packInformation(const Matrix6d& information);
[[nodiscard]] Matrix6d unpackInformation(const PackedInformation& packed);

/// What travels of `PlaneCloudStatistics` besides its flags; what is out of range saturates, NaN
/// becomes 0.
struct PackedStatistics {
  std::uint16_t coverage = 0;           ///< [1e-4], at most 10000
  std::uint16_t point_plane_error = 0;  ///< [1e-5 m]
  std::uint16_t depth_error = 0;        ///< [1e-5 m]
  std::uint16_t fit_time = 0;           ///< [1e-4 s]
};

[[nodiscard]] PackedStatistics packStatistics(const PlaneCloudStatistics& statistics);
/// The flags are false.
[[nodiscard]] PlaneCloudStatistics unpackStatistics(const PackedStatistics& packed);

/// Focal lengths, principal point and distortion in single precision.
[[nodiscard]] CameraIntrinsics roundCamera(CameraIntrinsics camera);

/// `stamp` [s], >= 0, in whole nanoseconds.
[[nodiscard]] double roundStamp(double stamp);

/// The keyframe as the other side receives it.
[[nodiscard]] Keyframe asTravelled(Keyframe keyframe);

}  // namespace planecloud

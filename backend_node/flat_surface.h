// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "planecloud_slam/icap/icap_options.h"
#include "planecloud_slam/plane_fit/plane_cloud.h"

namespace planecloud {

/// Tiles of one keyframe that lie on one plane. All in the keyframe's optical frame.
struct FlatSurface {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();    ///< unit, pointing at the camera
  Eigen::Vector3d centroid = Eigen::Vector3d::Zero();  ///< of the tiles by area, on the plane [m]
  /// Unit vectors across the normal and each other, along the longer and the shorter side.
  Eigen::Matrix<double, 3, 2> axes = Eigen::Matrix<double, 3, 2>::Zero();
  /// Half the sides of the rectangle with the same spread, along the axes [m].
  Eigen::Vector2d half_sides = Eigen::Vector2d::Zero();
  double area = 0.0;  ///< of the tiles on the plane [m^2]
  /// Of the plane's height over the true one at the centroid [m] and its slopes along the axes
  /// [rad]: noise that averages out over pixels, and that which does not.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  /// Least distance of other tiles, as good as parallel, from the plane; infinite: none [m].
  double clearance = 0.0;
  bool confirmed = false;  ///< by another keyframe
  bool taken = false;      ///< an edge begins here; a second one would repeat its error
};

/// The large flat surfaces of a keyframe, largest in the image first: at least `min_area` [m^2],
/// not narrow, even within the noise of `options`. At most four.
[[nodiscard]] std::vector<FlatSurface> findFlatSurfaces(const PlaneCloud& planes, double min_area,
                                                        const IcapOptions& options);

}  // namespace planecloud

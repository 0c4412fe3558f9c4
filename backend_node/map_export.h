// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "planecloud_slam/backend_node/keyframe_colors.h"
#include "planecloud_slam/backend_node/map_snapshot.h"

namespace planecloud {

/// One line of the TUM trajectory format without its end, `stamp tx ty tz qx qy qz qw` [s, m, unit
/// quaternion with qw >= 0], in fixed digits: microseconds, micrometres.
[[nodiscard]] std::string tumLine(double stamp, const Eigen::Isometry3d& T);

/// The keyframes of `robot` (all its sessions) ordered by stamp: poses of the optical frame in the
/// map, TUM format. Each component has a frame of its own; a comment says where it changes.
[[nodiscard]] std::string trajectoryText(const MapSnapshot& snapshot, const std::string& robot);

/// The graph in g2o's text format: VERTEX_SE3:QUAT numbered as `snapshot.nodes`, EDGE_SE3:QUAT, FIX
/// for the first vertex of each component.
///
/// g2o's error of an edge is the translation and the *vector part of the quaternion* of
/// `T_measured^-1 T_estimate`; the latter is half the rotation vector. So the information is
/// `D I D` with `D = diag(1, 1, 1, 2, 2, 2)`; translation first and right perturbation are the
/// same.
[[nodiscard]] std::string g2oText(const MapSnapshot& snapshot);

/// Writes the plane map as binary PLY: a quadrilateral per tile, corners in the map's frame [m],
/// coloured by robot or, cut into smaller ones, with what the cameras saw. Throws
/// std::runtime_error when the file cannot be written.
void writePlaneMap(const std::string& path, const MapSnapshot& snapshot,
                   MapColoring coloring = MapColoring::kRobot);

/// Writes `map.ply`, `map_textured.ply` when there is texture, `<robot>_keyframes.txt` for each
/// robot and `graph.g2o` into an existing directory. Returns the paths. Throws std::runtime_error
/// naming the file that cannot be written.
std::vector<std::string> exportMap(const std::string& directory, const MapSnapshot& snapshot);

}  // namespace planecloud

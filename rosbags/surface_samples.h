// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <string>
#include <vector>

#include "planecloud_slam/backend_node/map_snapshot.h"

namespace planecloud {

/// A small piece of a mapped surface.
struct SurfaceSample {
  Eigen::Vector3f position;  ///< [m]
  Eigen::Vector3f normal;    ///< unit, towards the camera that saw it
  float area = 0.0F;         ///< [m^2]
  int robot = 0;             ///< index as given to `sampleSurfaces`
};

/// Pieces of at most `spacing` [m] of the tiles of those keyframes of `component` whose tiles are
/// nearer than `range` [m]. `robots` gives the index of a robot by its place; keyframes of others
/// are left out. Positions and normals in the map, turned by `T_view_map`.
struct SurfaceSampling {
  std::vector<std::string> robots;
  int component = 0;
  double spacing = 0.02;
  double range = 5.0;
  Eigen::Isometry3d T_view_map = Eigen::Isometry3d::Identity();
};

/// Hands the pieces to `visit` one by one: a large map has more of them than memory.
void visitSurfaces(const MapSnapshot& map, const SurfaceSampling& sampling,
                   const std::function<void(const SurfaceSample&)>& visit);

/// All of them at once.
[[nodiscard]] std::vector<SurfaceSample> sampleSurfaces(const MapSnapshot& map,
                                                        const SurfaceSampling& sampling);

/// Rotation about z [rad] that brings the walls among `samples` parallel to the axes, in
/// (-pi/4, pi/4]; 0 without walls.
[[nodiscard]] double alignWallsWithAxes(const std::vector<SurfaceSample>& samples);

/// Height of the lowest large horizontal surface that faces up [m]; the lowest sample without one.
[[nodiscard]] float findFloorHeight(const std::vector<SurfaceSample>& samples);

}  // namespace planecloud

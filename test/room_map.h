// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "planecloud_slam/backend_node/map_snapshot.h"

namespace planecloud {

/// A camera of 160 x 120 pixels.
inline CameraIntrinsics smallCamera() {
  CameraIntrinsics camera;
  camera.width = 160;
  camera.height = 120;
  camera.fx = camera.fy = 140.0;
  camera.cx = 79.5;
  camera.cy = 59.5;
  return camera;
}

/// A level camera at (x, y) [m], 0.5 m above the ground, looking along `heading` [rad].
inline Eigen::Isometry3d levelCamera(double x, double y, double heading) {
  Eigen::Matrix3d axes;  // of the optical frame: right, down, forward
  axes << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() << x, y, 0.5;
  T.linear() = Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ()).toRotationMatrix() * axes;
  return T;
}

/// What a level camera sees of a wall `distance` [m] ahead and of the floor 0.5 m below it: tiles
/// of 20 x 20 pixels.
inline PlaneCloud wallAndFloor(double distance) {
  PlaneCloud cloud;
  cloud.camera = smallCamera();
  cloud.layout = {20, 20, 20};
  const double floor_row = cloud.camera.cy + cloud.camera.fy * 0.5 / distance;
  for (int y = 0; y < cloud.camera.height; y += 20) {
    for (int x = 0; x < cloud.camera.width; x += 20) {
      PlanarTile tile;
      tile.rect = {x, y, 20, 20};
      if (y < floor_row) {
        tile.inverse_depth = Eigen::Vector3f(0.0F, 0.0F, static_cast<float>(1.0 / distance));
      } else {
        tile.inverse_depth = Eigen::Vector3f(0.0F, 2.0F, 0.0F);
      }
      cloud.tiles.push_back(tile);
    }
  }
  return cloud;
}

/// Adds a keyframe that sees `cloud` from `T_map_camera`.
inline void addKeyframe(MapSnapshot& map, const KeyframeId& id, double stamp,
                        const Eigen::Isometry3d& T_map_camera, PlaneCloud cloud) {
  auto keyframe = std::make_shared<MapKeyframe>();
  keyframe->id = id;
  keyframe->stamp = stamp;
  keyframe->T_odom_camera = T_map_camera;
  keyframe->planes = MapPlanes(std::make_shared<const PlaneCloud>(std::move(cloud)));
  MapSnapshot::Node node;
  node.keyframe = keyframe;
  node.T_map_camera = T_map_camera;
  map.nodes.push_back(node);
  map.components = 1;
}

}  // namespace planecloud

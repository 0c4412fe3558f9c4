// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/backend_node/floor_level.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace planecloud {
namespace {

constexpr double kLeastArea = 0.5;        ///< of a floor [m^2]
constexpr double kLeastHeight = 0.05;     ///< of the camera above the floor [m]
constexpr double kHeightTolerance = 0.1;  ///< between tiles of one floor [m]
constexpr double kNormalTolerance = 0.1;  ///< between a tile and the mean normal [rad]
constexpr int kRefinements = 3;

struct FloorTile {
  Eigen::Vector3d normal;
  double height = 0.0;  ///< of the camera above the tile's plane [m]
  double area = 0.0;    ///< [m^2]
};

std::vector<FloorTile> facing(const PlaneCloud& planes, const Eigen::Vector3d& up,
                              double max_tilt) {
  const CameraIntrinsics& camera = planes.camera;
  std::vector<FloorTile> tiles;
  for (const PlanarTile& tile : planes.tiles) {
    const Eigen::Vector4d plane = tile.plane();
    const Eigen::Vector3d normal = plane.head<3>();
    if (normal.dot(up) < std::cos(max_tilt) || plane.w() < kLeastHeight) continue;
    const Eigen::Vector3d ray((tile.rect.x + 0.5 * tile.rect.width - camera.cx) / camera.fx,
                              (tile.rect.y + 0.5 * tile.rect.height - camera.cy) / camera.fy, 1.0);
    const double slant = -normal.dot(ray);
    if (slant < 1e-3) continue;
    const double z = plane.w() / slant;
    tiles.push_back(
        {normal, plane.w(), tile.rect.area() * z * z / (camera.fx * camera.fy * slant)});
  }
  return tiles;
}

/// Height that half of the area lies below: robust against steps and low furniture.
double medianHeight(std::vector<FloorTile> tiles) {
  std::sort(tiles.begin(), tiles.end(),
            [](const FloorTile& a, const FloorTile& b) { return a.height < b.height; });
  double total = 0.0;
  for (const FloorTile& tile : tiles) total += tile.area;
  double sum = 0.0;
  for (const FloorTile& tile : tiles) {
    sum += tile.area;
    if (sum >= 0.5 * total) return tile.height;
  }
  return 0.0;
}

}  // namespace

std::optional<Eigen::Vector3d> findFloorNormal(const PlaneCloud& planes,
                                               const Eigen::Vector3d& up_camera, double max_tilt) {
  const std::vector<FloorTile> tiles = facing(planes, up_camera, max_tilt);
  const double height = medianHeight(tiles);
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  double area = 0.0;
  for (int round = 0; round <= kRefinements; ++round) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    area = 0.0;
    for (const FloorTile& tile : tiles) {
      if (std::abs(tile.height - height) > kHeightTolerance) continue;
      if (round > 0 && tile.normal.dot(mean) < std::cos(kNormalTolerance)) continue;
      sum += tile.area * tile.normal;
      area += tile.area;
    }
    if (area < kLeastArea) return std::nullopt;
    mean = sum.normalized();
  }
  return mean;
}

Eigen::Isometry3d rotationBetween(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::Quaterniond::FromTwoVectors(from, to).toRotationMatrix();
  return T;
}

}  // namespace planecloud

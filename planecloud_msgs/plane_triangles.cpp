// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/planecloud_msgs/plane_triangles.h"

#include <algorithm>
#include <array>
#include <utility>

namespace planecloud_slam {
namespace {

using Corners = std::array<geometry_msgs::Point, 4>;

geometry_msgs::Point cornerOf(const PlanarTile& tile, const Camera& camera, int x, int y) {
  const float u = camera.tangentsX()(x, y);
  const float v = camera.tangentsY()(x, y);
  geometry_msgs::Point point;
  point.z = tile.depthAt(u, v);
  point.x = u * point.z;
  point.y = v * point.z;
  return point;
}

/// In the order of a walk around the tile. Neighbours share their corners.
Corners cornersOf(const PlanarTile& tile, const Camera& camera) {
  const int right = std::min(tile.rect.x + tile.rect.width, camera.width() - 1);
  const int bottom = std::min(tile.rect.y + tile.rect.height, camera.height() - 1);
  return {cornerOf(tile, camera, tile.rect.x, tile.rect.y),
          cornerOf(tile, camera, tile.rect.x, bottom), cornerOf(tile, camera, right, bottom),
          cornerOf(tile, camera, right, tile.rect.y)};
}

}  // namespace

std::vector<geometry_msgs::Point> tileTriangles(const PlaneCloud& cloud, const Camera& camera,
                                                double max_depth) {
  std::vector<geometry_msgs::Point> triangles;
  triangles.reserve(6 * cloud.tiles.size());
  for (const PlanarTile& tile : cloud.tiles) {
    const Corners corners = cornersOf(tile, camera);
    const bool is_near = std::all_of(corners.begin(), corners.end(), [&](const auto& corner) {
      return corner.z > 0.0 && corner.z <= max_depth;
    });
    if (!is_near) continue;
    for (const std::size_t i : {0, 1, 2, 0, 2, 3}) triangles.push_back(corners[i]);
  }
  return triangles;
}

visualization_msgs::Marker makeTriangleMarker(std::vector<geometry_msgs::Point> triangles,
                                              const std_msgs::ColorRGBA& color) {
  visualization_msgs::Marker marker;
  marker.type = visualization_msgs::Marker::TRIANGLE_LIST;
  marker.action = visualization_msgs::Marker::ADD;
  marker.pose.orientation.w = 1.0;
  marker.scale.x = marker.scale.y = marker.scale.z = 1.0;
  marker.color = color;
  marker.points = std::move(triangles);
  return marker;
}

}  // namespace planecloud_slam

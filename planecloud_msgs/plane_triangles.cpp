// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/planecloud_msgs/plane_triangles.h"

#include <array>
#include <utility>

#include "planecloud_slam/plane_fit/reconstruction.h"

namespace planecloud {
namespace {

geometry_msgs::Point toPoint(const Eigen::Vector3d& point) {
  geometry_msgs::Point message;
  message.x = point.x();
  message.y = point.y();
  message.z = point.z();
  return message;
}

}  // namespace

std::vector<geometry_msgs::Point> tileTriangles(const PlaneCloud& cloud, double max_depth) {
  std::vector<geometry_msgs::Point> triangles;
  triangles.reserve(6 * cloud.tiles.size());
  for (const PlanarTile& tile : cloud.tiles) {
    const auto corners = tileCorners(tile, cloud.camera, max_depth);
    if (!corners) continue;
    for (const std::size_t i : {0, 3, 2, 0, 2, 1}) triangles.push_back(toPoint((*corners)[i]));
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

}  // namespace planecloud

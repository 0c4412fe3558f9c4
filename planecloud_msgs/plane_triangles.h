// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <geometry_msgs/Point.h>
#include <std_msgs/ColorRGBA.h>
#include <visualization_msgs/Marker.h>

#include <vector>

#include "planecloud_slam/plane_fit/plane_cloud.h"

namespace planecloud {

/// Two triangles for each tile of `cloud`, three points each [m], in its optical frame, front sides
/// towards the camera. Tiles that reach beyond `max_depth` [m] are left out.
[[nodiscard]] std::vector<geometry_msgs::Point> tileTriangles(const PlaneCloud& cloud,
                                                              double max_depth);

/// A marker with identity pose and scale for `triangles`; header and id are the caller's.
[[nodiscard]] visualization_msgs::Marker makeTriangleMarker(
    std::vector<geometry_msgs::Point> triangles, const std_msgs::ColorRGBA& color);

}  // namespace planecloud

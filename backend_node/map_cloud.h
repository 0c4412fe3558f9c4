// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <sensor_msgs/PointCloud2.h>
#include <std_msgs/Header.h>

#include <map>
#include <memory>

#include "planecloud_slam/backend_node/keyframe_colors.h"
#include "planecloud_slam/backend_node/map_snapshot.h"
#include "planecloud_slam/backend_node/robot_colors.h"
#include "planecloud_slam/plane_fit/camera.h"

namespace planecloud {

/// Points sampled from the planes of the map, one for each cell of a grid, coloured by robot or
/// texture. Remembers the points of each keyframe. For one thread.
class MapCloudBuilder {
 public:
  /// `resolution`: side of a cell [m].
  MapCloudBuilder(double resolution, MapColoring coloring)
      : resolution_(static_cast<float>(resolution)), coloring_(coloring) {}

  /// The points of all keyframes whose relation to the map is known [m].
  [[nodiscard]] sensor_msgs::PointCloud2 build(const MapSnapshot& snapshot,
                                               const std_msgs::Header& header);

 private:
  using Cloud = pcl::PointCloud<pcl::PointXYZRGB>;
  struct KeyframeCloud {
    Cloud points;              ///< in the optical frame [m]
    bool has_texture = false;  ///< else the points have no colour yet
  };

  const KeyframeCloud& cloudOf(const MapKeyframe& keyframe);
  const Camera& cameraOf(const CameraIntrinsics& intrinsics);

  const float resolution_;
  const MapColoring coloring_;
  std::map<KeyframeId, KeyframeCloud> clouds_;
  std::unique_ptr<Camera> camera_;
};

}  // namespace planecloud

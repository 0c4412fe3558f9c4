// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/backend_node/map_cloud.h"

#include <pcl/common/transforms.h>
#include <pcl/filters/voxel_grid.h>
#include <pcl_conversions/pcl_conversions.h>

#include "planecloud_slam/backend_node/robot_colors.h"
#include "planecloud_slam/plane_fit/reconstruction.h"

namespace planecloud {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZRGB>;

/// Distance of the sampled pixels [px].
constexpr int kPixelStep = 4;

Cloud thinOut(const Cloud& cloud, float cell) {
  pcl::VoxelGrid<pcl::PointXYZRGB> grid;
  grid.setInputCloud(cloud.makeShared());
  grid.setLeafSize(cell, cell, cell);
  Cloud thin;
  grid.filter(thin);
  return thin;
}

}  // namespace

const Camera& MapCloudBuilder::cameraOf(const CameraIntrinsics& intrinsics) {
  if (!camera_ || camera_->intrinsics() != intrinsics) {
    camera_ = std::make_unique<Camera>(intrinsics);
  }
  return *camera_;
}

const MapCloudBuilder::KeyframeCloud& MapCloudBuilder::cloudOf(const MapKeyframe& keyframe) {
  const auto [entry, is_new] = clouds_.try_emplace(keyframe.id);
  if (!is_new) return entry->second;
  Cloud cloud;
  const PlaneCloud& planes = *keyframe.planes;
  const KeyframeColors colors =
      coloring_ == MapColoring::kTexture ? KeyframeColors(*keyframe.keyframe) : KeyframeColors();
  for (const Eigen::Vector3f& point :
       reconstructPoints(planes, cameraOf(planes.camera), kPixelStep)) {
    const Rgb8 color = colors.at(point.cast<double>(), {});
    pcl::PointXYZRGB colored(color.r, color.g, color.b);
    colored.getVector3fMap() = point;
    cloud.push_back(colored);
  }
  entry->second = {thinOut(cloud, resolution_), !colors.empty()};
  return entry->second;
}

sensor_msgs::PointCloud2 MapCloudBuilder::build(const MapSnapshot& snapshot,
                                                const std_msgs::Header& header) {
  if (snapshot.nodes.size() < clouds_.size()) clouds_.clear();
  const std::map<std::string, RobotColor> colors = robotColors(snapshot);
  Cloud map;
  for (const MapSnapshot::Node& node : snapshot.nodes) {
    if (node.component != 0) continue;
    const RobotColor& color = colors.at(node.keyframe->id.robot);
    Cloud cloud;
    const KeyframeCloud& known = cloudOf(*node.keyframe);
    pcl::transformPointCloud(known.points, cloud, node.T_map_camera.matrix().cast<float>().eval());
    for (pcl::PointXYZRGB& point : cloud) {
      if (known.has_texture) break;
      point.r = color.r;
      point.g = color.g;
      point.b = color.b;
    }
    map += cloud;
  }
  sensor_msgs::PointCloud2 message;
  pcl::toROSMsg(thinOut(map, resolution_), message);
  message.header = header;
  return message;
}

}  // namespace planecloud

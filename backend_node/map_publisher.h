// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/ros.h>
#include <tf2_ros/transform_broadcaster.h>

#include <Eigen/Geometry>
#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "planecloud_slam/backend_node/backend_node_options.h"
#include "planecloud_slam/backend_node/map_cloud.h"
#include "planecloud_slam/backend_node/map_markers.h"
#include "planecloud_slam/backend_node/map_snapshot.h"
#include "planecloud_slam/plane_fit/bounded_queue.h"

namespace planecloud {

/// Shows the map to others: `plane_map`, `map_cloud`, `pose_graph`, `rejected_closures`, a `path`
/// for each robot and tf `map -> odom`. Works on snapshots in its own thread, so that nobody waits
/// for it.
class MapPublisher {
 public:
  MapPublisher(const ros::NodeHandle& node, const BackendNodeOptions& options);
  ~MapPublisher();

  /// Publishes `snapshot` unless a newer one comes first.
  void show(std::shared_ptr<const MapSnapshot> snapshot);

 private:
  using Snapshot = std::shared_ptr<const MapSnapshot>;

  void publishLoop();
  void publish(const MapSnapshot& snapshot);
  void publishPaths(const MapSnapshot& snapshot, const std_msgs::Header& header);
  /// Somebody subscribed to what is sent in parts: everything goes out once more.
  void onNewSubscriber();
  /// Publishes what is known now to those who see nothing yet.
  void publishLatest();
  void updateTransforms(const MapSnapshot& snapshot);
  void broadcastTransforms();

  const BackendNodeOptions options_;
  ros::NodeHandle node_;
  PlaneMapMarkers plane_map_;
  MapCloudBuilder cloud_builder_;
  std::mutex mutex_;
  Snapshot latest_;
  std::vector<geometry_msgs::TransformStamped> transforms_;
  ros::Time last_stamp_;      ///< of the transforms
  ros::Time last_broadcast_;  ///< of them, when it was
  std::atomic<bool> start_over_{false};
  std::map<std::string, ros::Publisher> path_publishers_;  ///< by robot
  ros::Publisher plane_map_publisher_;
  ros::Publisher cloud_publisher_;
  ros::Publisher graph_publisher_;
  ros::Publisher rejected_publisher_;
  tf2_ros::TransformBroadcaster broadcaster_;
  ros::WallTimer timer_;
  BoundedQueue<Snapshot> snapshots_;
  std::thread publishing_;
};

}  // namespace planecloud

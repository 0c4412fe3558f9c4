// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <planecloud_slam/ExportMap.h>
#include <ros/ros.h>
#include <std_srvs/Trigger.h>

#include <atomic>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "planecloud_slam/backend_node/backend.h"
#include "planecloud_slam/backend_node/backend_node_options.h"
#include "planecloud_slam/backend_node/keyframe_receiver.h"
#include "planecloud_slam/backend_node/map_publisher.h"
#include "planecloud_slam/plane_fit/bounded_queue.h"
#include "planecloud_slam/planecloud_msgs/log_throttle.h"

namespace planecloud {

/// The backend as a ROS node: keyframes in, the map out. One thread owns the map and takes
/// keyframes in the order of their arrival; it waits for nobody. Another one optimises the whole
/// graph now and then.
class BackendNode {
 public:
  /// Throws std::invalid_argument for options that cannot be.
  BackendNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
              const BackendNodeOptions& options);
  ~BackendNode();

 private:
  /// Work for the owner of the map: a keyframe, or something to do with the whole of it.
  struct Task {
    std::optional<Keyframe> keyframe;
    std::size_t source = 0;
    std::function<void()> command;
    std::shared_ptr<std::promise<void>> done;
  };

  void work();
  void insert(Task task);
  void optimiseWhenDue();
  void reportInsertion(const KeyframeId& id, const InsertionResult& result);
  /// Runs `command` in the thread that owns the map and waits for it.
  void runInOrder(std::function<void()> command);
  void publishState();

  bool onOptimize(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool onReset(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool onExport(planecloud_slam::ExportMap::Request& request,
                planecloud_slam::ExportMap::Response& response);
  void publishDiagnostics();

  LogThrottle log_;
  Backend backend_;  ///< touched by `working_` only
  std::mutex mutex_;
  std::shared_ptr<const MapSnapshot> snapshot_;
  BackendStatistics statistics_;
  std::atomic<double> insert_time_{0.0};  ///< of the last keyframe [s]
  std::atomic<std::size_t> refused_{0};
  std::atomic<bool> stopping_{false};

  MapPublisher map_publisher_;
  BoundedQueue<Task> tasks_;
  std::future<void> optimising_;  ///< the whole graph; touched by `working_` only
  KeyframeReceiver receiver_;
  ros::Publisher diagnostics_;
  ros::ServiceServer optimize_service_;
  ros::ServiceServer reset_service_;
  ros::ServiceServer export_service_;
  ros::WallTimer timer_;
  std::thread working_;
};

}  // namespace planecloud

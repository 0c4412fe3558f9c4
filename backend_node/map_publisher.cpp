// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/backend_node/map_publisher.h"

#include <algorithm>
#include <utility>

#include "planecloud_slam/planecloud_msgs/pose_conversions.h"

namespace planecloud {
namespace {

constexpr std::uint32_t kQueue = 2;
constexpr bool kLatch = true;
/// How long a transform is valid, in periods: timers are late at times.
constexpr double kTfValidity = 1.5;
/// Simulated time may run this much faster than the timer's.
constexpr double kFastestClock = 5.0;

/// The frame of a component: the map, or one of its own as long as the relation is unknown.
std::string frameOfComponent(const std::string& map_frame, int component) {
  return component == 0 ? map_frame : map_frame + "_" + std::to_string(component);
}

}  // namespace

MapPublisher::MapPublisher(const ros::NodeHandle& node, const BackendNodeOptions& options)
    : options_(options),
      node_(node),
      plane_map_({options.max_depth, options.max_height, options.map_coloring}),
      cloud_builder_(options.cloud_resolution, options.map_coloring),
      snapshots_(1) {
  const auto on_new = [this](const ros::SingleSubscriberPublisher&) { onNewSubscriber(); };
  const auto on_request = [this](const ros::SingleSubscriberPublisher&) { publishLatest(); };
  plane_map_publisher_ =
      node_.advertise<visualization_msgs::MarkerArray>("plane_map", kQueue, on_new);
  cloud_publisher_ = node_.advertise<sensor_msgs::PointCloud2>("map_cloud", kQueue, on_new);
  graph_publisher_ = node_.advertise<visualization_msgs::MarkerArray>("pose_graph", kQueue, kLatch);
  rejected_publisher_ =
      node_.advertise<visualization_msgs::MarkerArray>("rejected_closures", kQueue, on_request);
  timer_ = node_.createWallTimer(ros::WallDuration(options.tf_period),
                                 [this](const ros::WallTimerEvent&) { broadcastTransforms(); });
  publishing_ = std::thread([this] { publishLoop(); });
}

MapPublisher::~MapPublisher() {
  timer_.stop();
  plane_map_publisher_.shutdown();
  cloud_publisher_.shutdown();
  rejected_publisher_.shutdown();
  snapshots_.close();
  publishing_.join();
}

void MapPublisher::show(std::shared_ptr<const MapSnapshot> snapshot) {
  updateTransforms(*snapshot);
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    latest_ = snapshot;
  }
  snapshots_.pushDroppingOldest(std::move(snapshot));
}

void MapPublisher::onNewSubscriber() {
  start_over_ = true;
  publishLatest();
}

void MapPublisher::publishLatest() {
  Snapshot latest;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    latest = latest_;
  }
  if (latest) snapshots_.pushDroppingOldest(std::move(latest));
}

void MapPublisher::publishLoop() {
  while (std::optional<Snapshot> snapshot = snapshots_.pop()) {
    const ros::WallTime next = ros::WallTime::now() + ros::WallDuration(options_.publish_period);
    publish(**snapshot);
    // In short steps: the destructor must not wait long.
    while (ros::ok() && ros::WallTime::now() < next) ros::WallDuration(0.02).sleep();
  }
}

void MapPublisher::publish(const MapSnapshot& snapshot) {
  std_msgs::Header header;
  header.frame_id = options_.map_frame;
  header.stamp = ros::Time::now();
  if (start_over_.exchange(false)) plane_map_.forget();
  if (plane_map_publisher_.getNumSubscribers() > 0) {
    const visualization_msgs::MarkerArray planes = plane_map_.update(snapshot, header);
    if (!planes.markers.empty()) plane_map_publisher_.publish(planes);
  }
  if (cloud_publisher_.getNumSubscribers() > 0) {
    cloud_publisher_.publish(cloud_builder_.build(snapshot, header));
  }
  graph_publisher_.publish(makeGraphMarkers(snapshot, header));
  if (rejected_publisher_.getNumSubscribers() > 0) {
    rejected_publisher_.publish(makeRejectedMarkers(snapshot, header));
  }
  publishPaths(snapshot, header);
}

void MapPublisher::publishPaths(const MapSnapshot& snapshot, const std_msgs::Header& header) {
  const bool is_one = splitWords(options_.robots).empty();
  for (const auto& [robot, path] : makePaths(snapshot, header)) {
    ros::Publisher& publisher = path_publishers_[robot];
    if (!publisher) {
      publisher =
          node_.advertise<nav_msgs::Path>(is_one ? "path" : robot + "/path", kQueue, kLatch);
    }
    publisher.publish(path);
  }
}

void MapPublisher::updateTransforms(const MapSnapshot& snapshot) {
  std::map<std::string, const MapSnapshot::Node*> newest;
  for (const MapSnapshot::Node& node : snapshot.nodes) {
    newest[node.keyframe->id.robot] = &node;  // nodes are ordered by session, then number
  }
  const std::vector<std::string> wanted = splitWords(options_.tf_robots);
  std::vector<geometry_msgs::TransformStamped> transforms;
  std::map<std::string, std::string> placed;  // robot by its frame
  for (const auto& [robot, node] : newest) {
    const bool is_wanted = std::find(wanted.begin(), wanted.end(), robot) != wanted.end();
    if (!wanted.empty() && !is_wanted) continue;
    const std::string frame = frameOfRobot(options_.odom_frame, robot);
    const auto [taken, is_first] = placed.emplace(frame, robot);
    if (!is_first) {
      ROS_WARN_STREAM_THROTTLE(10.0, "robots " << taken->second << " and " << robot
                                               << " share the odometry frame '" << frame
                                               << "': only the first is placed by tf; set "
                                                  "~odom_frame to {robot}/odom, or to what their "
                                                  "bases publish");
      continue;
    }
    geometry_msgs::TransformStamped transform;
    transform.header.frame_id = frameOfComponent(options_.map_frame, node->component);
    transform.child_frame_id = frame;
    transform.transform =
        toTransformMessage(node->T_map_camera * node->keyframe->T_odom_camera.inverse());
    transforms.push_back(std::move(transform));
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  transforms_ = std::move(transforms);
}

void MapPublisher::broadcastTransforms() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (transforms_.empty()) return;
  // As amcl does: valid until the next one is there, or nobody could look up the present.
  const ros::Time now = ros::Time::now();
  const double since_last = last_broadcast_.isZero() ? 0.0 : (now - last_broadcast_).toSec();
  last_broadcast_ = now;
  const double period = options_.tf_period;
  const double until_next = std::clamp(since_last, period, kFastestClock * period);
  ros::Time stamp = now + ros::Duration(kTfValidity * until_next);
  // While a bag is paused, time stands still; the same stamp again would be refused.
  const bool stands_still = stamp <= last_stamp_ && last_stamp_ - stamp < ros::Duration(1.0);
  if (stands_still) stamp = last_stamp_ + ros::Duration(0, 1000);
  last_stamp_ = stamp;
  for (geometry_msgs::TransformStamped& transform : transforms_) transform.header.stamp = stamp;
  broadcaster_.sendTransform(transforms_);
}

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/backend_node/backend_node.h"

#include <filesystem>
#include <utility>

#include "planecloud_slam/backend_node/map_export.h"
#include "planecloud_slam/planecloud_msgs/diagnostics.h"

namespace planecloud {

BackendNode::BackendNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                         const BackendNodeOptions& options)
    : backend_(options.backend),
      snapshot_(backend_.snapshot()),
      map_publisher_(node, options),
      tasks_(0),
      receiver_(node, options, [this](Keyframe keyframe, std::size_t source) {
        tasks_.push({std::move(keyframe), source, nullptr, nullptr});
      }) {
  ros::NodeHandle node_handle(node);
  ros::NodeHandle private_handle(private_node);
  diagnostics_ = node_handle.advertise<diagnostic_msgs::DiagnosticArray>("/diagnostics", 10);
  optimize_service_ = private_handle.advertiseService("optimize", &BackendNode::onOptimize, this);
  reset_service_ = private_handle.advertiseService("reset", &BackendNode::onReset, this);
  export_service_ = private_handle.advertiseService("export", &BackendNode::onExport, this);
  timer_ = node_handle.createWallTimer(
      ros::WallDuration(1.0), [this](const ros::WallTimerEvent&) { publishDiagnostics(); });
  working_ = std::thread([this] { work(); });
}

BackendNode::~BackendNode() {
  stopping_ = true;
  tasks_.close();
  working_.join();
  while (tasks_.pop()) continue;  // services that wait for what will not be done are told so
}

void BackendNode::work() {
  while (std::optional<Task> task = tasks_.pop()) {
    if (stopping_) break;
    if (task->keyframe) {
      insert(std::move(*task));
    } else {
      task->command();
      task->done->set_value();
    }
  }
}

void BackendNode::insert(Task task) {
  const KeyframeId id = task.keyframe->id;
  const ros::WallTime start = ros::WallTime::now();
  const InsertionResult result = backend_.insert(std::move(*task.keyframe));
  insert_time_ = (ros::WallTime::now() - start).toSec();
  publishState();
  receiver_.settle(task.source, id);
  reportInsertion(id, result);
  optimiseWhenDue();
}

void BackendNode::optimiseWhenDue() {
  if (optimising_.valid() || !backend_.optimisationDue()) return;
  const auto optimisation = std::make_shared<GraphOptimisation>(backend_.startOptimisation());
  const auto take_over = [this, optimisation] {
    backend_.finishOptimisation(*optimisation);
    optimising_ = {};
    publishState();
    optimiseWhenDue();
  };
  optimising_ = std::async(std::launch::async, [this, optimisation, take_over] {
    optimisation->run();
    tasks_.push({std::nullopt, 0, take_over, std::make_shared<std::promise<void>>()});
  });
}

void BackendNode::reportInsertion(const KeyframeId& id, const InsertionResult& result) {
  if (result.status == InsertionStatus::kRefused || result.status == InsertionStatus::kNameClash) {
    ++refused_;
    log_.error(result.reason, id.robot);
  }
  for (const GraphEdge& closure : result.closures) {
    ROS_INFO_STREAM("loop closure between " << toString(closure.from) << " and "
                                            << toString(closure.to));
  }
}

void BackendNode::publishState() {
  std::shared_ptr<const MapSnapshot> snapshot = backend_.snapshot();
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    snapshot_ = snapshot;
    statistics_ = backend_.statistics();
  }
  map_publisher_.show(std::move(snapshot));
}

void BackendNode::runInOrder(std::function<void()> command) {
  auto done = std::make_shared<std::promise<void>>();
  std::future<void> future = done->get_future();
  tasks_.push({std::nullopt, 0, std::move(command), std::move(done)});
  future.get();
}

bool BackendNode::onOptimize(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  try {
    runInOrder([this] {
      backend_.optimize();
      publishState();
    });
  } catch (const std::future_error&) {
    response.message = "the backend is stopping";
    return true;
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  response.success = true;
  response.message = std::to_string(statistics_.keyframes) + " keyframes optimised";
  return true;
}

bool BackendNode::onReset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  try {
    runInOrder([this] {
      backend_.reset();
      publishState();
    });
  } catch (const std::future_error&) {
    response.message = "the backend is stopping";
    return true;
  }
  // What was acknowledged stays so: the map begins anew with the keyframes to come.
  response.success = true;
  response.message = "the map is empty";
  return true;
}

bool BackendNode::onExport(planecloud_slam::ExportMap::Request& request,
                           planecloud_slam::ExportMap::Response& response) {
  std::shared_ptr<const MapSnapshot> snapshot;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    snapshot = snapshot_;
  }
  try {
    const std::filesystem::path directory =
        std::filesystem::absolute(request.directory.empty() ? "." : request.directory);
    std::filesystem::create_directories(directory);
    response.files = exportMap(directory.lexically_normal().string(), *snapshot);
    response.success = true;
    response.message = std::to_string(snapshot->nodes.size()) + " keyframes written";
  } catch (const std::exception& error) {
    response.message = error.what();
  }
  return true;
}

void BackendNode::publishDiagnostics() {
  BackendStatistics statistics;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    statistics = statistics_;
  }
  DiagnosticStatus status(ros::this_node::getName(), "map", "");
  if (receiver_.malformed() + refused_ > 0) status.warn("some keyframes were refused");
  status.add("keyframes", statistics.keyframes);
  status.add("keyframes waiting", tasks_.size());
  status.add("keyframes missing", receiver_.missing());
  status.add("keyframes repeated", receiver_.repeated());
  status.add("keyframes refused", receiver_.malformed() + refused_);
  status.add("components", statistics.components);
  status.add("closures within a robot", statistics.closures_intra);
  status.add("closures between robots", statistics.closures_inter);
  for (const auto& [reason, count] : statistics.rejected) {
    status.add("closures rejected: " + reason, count);
  }
  status.add("insertion time [s]", insert_time_);
  diagnostics_.publish(status.toMessage());
}

}  // namespace planecloud

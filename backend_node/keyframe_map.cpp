// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/backend_node/keyframe_map.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "planecloud_slam/backend_node/drift_model.h"
#include "planecloud_slam/backend_node/floor_level.h"

namespace planecloud {
namespace {

std::vector<GraphEdge> graphEdges(const Keyframe& keyframe) {
  std::vector<GraphEdge> edges;
  for (const RelativePoseEdge& edge : keyframe.edges) {
    GraphEdge result;
    result.kind = edges.empty() ? EdgeKind::kOdometry : EdgeKind::kHistory;
    result.from = edge.other;
    result.to = keyframe.id;
    result.T_from_to = edge.T_other_this;
    result.information = edge.information;
    result.inter_robot = edge.other.robot != keyframe.id.robot;
    edges.push_back(std::move(result));
  }
  return edges;
}

}  // namespace

int KeyframeMap::add(Keyframe keyframe, const PlaneCloud& planes) {
  const KeyframeId id = keyframe.id;
  std::vector<GraphEdge> edges = graphEdges(keyframe);
  const int node = graph_.addNode(id, initialPose(keyframe, edges));
  records_.push_back(makeRecord(std::move(keyframe), planes));
  followHints(node);
  const auto waited = waiting_.find(id);
  if (waited != waiting_.end()) {
    edges.insert(edges.end(), waited->second.begin(), waited->second.end());
    waiting_.erase(waited);
  }
  for (const GraphEdge& edge : edges) {
    const bool known = graph_.find(edge.from).has_value();
    if (known) {
      connect(edge);
    } else {
      waiting_[edge.from].push_back(edge);
    }
  }
  level(node, planes);
  return node;
}

void KeyframeMap::followHints(int node) {
  KeyframeRecord& record = records_[static_cast<std::size_t>(node)];
  for (const KeyframeId& hint : record.keyframe->keyframe->closure_hints) {
    if (!graph_.find(hint)) hinted_by_[hint].push_back(node);
  }
  const auto waited = hinted_by_.find(record.keyframe->id);
  if (waited == hinted_by_.end()) return;
  record.hinted_by = std::move(waited->second);
  hinted_by_.erase(waited);
}

std::optional<int> KeyframeMap::predecessor(const KeyframeId& id) const {
  const auto next = graph_.numbers().lower_bound(id);
  if (next == graph_.numbers().begin()) return std::nullopt;
  const auto& [before, node] = *std::prev(next);
  if (!sameSession(before, id)) return std::nullopt;
  return node;
}

Eigen::Isometry3d KeyframeMap::initialPose(const Keyframe& keyframe,
                                           const std::vector<GraphEdge>& edges) const {
  for (const GraphEdge& edge : edges) {
    const std::optional<int> other = graph_.find(edge.from);
    if (other) return graph_.pose(*other) * edge.T_from_to;
  }
  // A segment of unknown relation: where odometry would have it, so that pictures look sensible.
  const std::optional<int> before = predecessor(keyframe.id);
  if (!before) return keyframe.T_odom_camera;
  const MapKeyframe& known = *records_[static_cast<std::size_t>(*before)].keyframe;
  return graph_.pose(*before) * known.T_odom_camera.inverse() * keyframe.T_odom_camera;
}

KeyframeRecord KeyframeMap::makeRecord(Keyframe keyframe, const PlaneCloud& planes) const {
  KeyframeRecord record;
  if (const std::optional<int> before = predecessor(keyframe.id)) {
    const KeyframeRecord& known = records_[static_cast<std::size_t>(*before)];
    record.path =
        known.path + motionLength(known.keyframe->T_odom_camera.inverse() * keyframe.T_odom_camera);
  }
  auto map_keyframe = std::make_shared<MapKeyframe>();
  map_keyframe->id = keyframe.id;
  map_keyframe->stamp = keyframe.stamp;
  map_keyframe->T_odom_camera = keyframe.T_odom_camera;
  std::vector<RelativePoseEdge>().swap(keyframe.edges);  // they are in the graph
  keyframe.planes.bytes.shrink_to_fit();
  keyframe.descriptor.shrink_to_fit();
  map_keyframe->keyframe = std::make_shared<const Keyframe>(std::move(keyframe));
  map_keyframe->planes = MapPlanes(map_keyframe->keyframe);
  record.sketch = sketchView(planes);
  record.keyframe = std::move(map_keyframe);
  return record;
}

void KeyframeMap::connect(const GraphEdge& edge) {
  const int from = graph_.find(edge.from).value();
  const int to = graph_.find(edge.to).value();
  // What a frontend measured joins components at once; the older one keeps its frame.
  if (graph_.component(from) < graph_.component(to)) {
    graph_.moveComponent(graph_.component(to),
                         graph_.pose(from) * edge.T_from_to * graph_.pose(to).inverse());
  } else if (graph_.component(to) < graph_.component(from)) {
    graph_.moveComponent(graph_.component(from),
                         graph_.pose(to) * edge.T_from_to.inverse() * graph_.pose(from).inverse());
  }
  graph_.addEdge(edge);
}

void KeyframeMap::level(int node, const PlaneCloud& planes) {
  if (!frame_.level_with_floor) return;
  const int component = graph_.component(node);
  const std::vector<int>& members = graph_.members(component);
  const int oldest = members.front();
  const bool late = static_cast<int>(members.size()) > frame_.level_keyframes;
  if (late || levelled_.count(graph_.id(oldest)) > 0) return;
  const MapKeyframe& keyframe = *records_[static_cast<std::size_t>(node)].keyframe;
  const Eigen::Vector3d up_odom = keyframe.T_odom_camera.linear().row(2).transpose();
  const std::optional<Eigen::Vector3d> floor =
      findFloorNormal(planes, up_odom, frame_.max_floor_tilt);
  if (!floor) return;
  const Eigen::Vector3d up_map = graph_.pose(node).linear() * *floor;
  const Eigen::Isometry3d& T_map_oldest = graph_.pose(oldest);
  const Eigen::Translation3d origin(T_map_oldest.translation());
  graph_.moveComponent(
      component, origin * rotationBetween(up_map, Eigen::Vector3d::UnitZ()) * origin.inverse());
  levelled_.insert(graph_.id(oldest));
}

MapSnapshot KeyframeMap::snapshot() const {
  MapSnapshot snapshot;
  snapshot.nodes.reserve(records_.size());
  for (const auto& [id, node] : graph_.numbers()) {
    snapshot.nodes.push_back({records_[static_cast<std::size_t>(node)].keyframe, graph_.pose(node),
                              graph_.component(node)});
  }
  snapshot.edges = graph_.edges();
  snapshot.components = graph_.components();
  return snapshot;
}

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/backend_node/map_markers.h"

#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "planecloud_slam/plane_fit/se3.h"
#include "planecloud_slam/planecloud_msgs/plane_triangles.h"
#include "planecloud_slam/planecloud_msgs/pose_conversions.h"

namespace planecloud {
namespace {

/// Smaller moves are not worth sending the planes of a keyframe again.
constexpr double kVisibleMove = 0.01;       // [m]
constexpr double kVisibleRotation = 0.003;  // [rad]
constexpr float kJoinedAlpha = 1.0F;
/// Keyframes whose relation to the map is unknown show through.
constexpr float kSeparateAlpha = 0.3F;
constexpr double kNodeSize = 0.09;       // [m]
constexpr double kRejectedWidth = 0.01;  // [m]
/// Patches seen more grazingly (cosine between normal and ray) are streaks along depth jumps.
constexpr double kMinIncidence = 0.12;

std_msgs::ColorRGBA makeColor(const RobotColor& color, float alpha) {
  std_msgs::ColorRGBA message;
  message.r = static_cast<float>(color.r) / 255.0F;
  message.g = static_cast<float>(color.g) / 255.0F;
  message.b = static_cast<float>(color.b) / 255.0F;
  message.a = alpha;
  return message;
}

const std_msgs::ColorRGBA kHistoryColor = makeColor({150, 150, 150}, 0.5F);
const std_msgs::ColorRGBA kCoplanarColor = makeColor({30, 160, 170}, 0.7F);
const std_msgs::ColorRGBA kClosureColor = makeColor({220, 20, 40}, 1.0F);
const std_msgs::ColorRGBA kInterRobotColor = makeColor({255, 0, 200}, 1.0F);
const std_msgs::ColorRGBA kRejectedColor = makeColor({220, 20, 40}, 0.6F);

geometry_msgs::Point positionOf(const Eigen::Isometry3d& T_map_camera) {
  return toPoseMessage(T_map_camera).position;
}

visualization_msgs::Marker makeMarker(const std::string& ns, int type, double size) {
  visualization_msgs::Marker marker;
  marker.ns = ns;
  marker.type = type;
  marker.action = visualization_msgs::Marker::ADD;
  marker.pose.orientation.w = 1.0;
  marker.scale.x = marker.scale.y = marker.scale.z = size;
  marker.color = kHistoryColor;
  return marker;
}

visualization_msgs::Marker makeDeleteAll(const std_msgs::Header& header) {
  visualization_msgs::Marker marker;
  marker.header = header;
  marker.action = visualization_msgs::Marker::DELETEALL;
  return marker;
}

using Nodes = std::map<KeyframeId, const MapSnapshot::Node*>;

Nodes indexNodes(const MapSnapshot& snapshot) {
  Nodes nodes;
  for (const MapSnapshot::Node& node : snapshot.nodes) nodes[node.keyframe->id] = &node;
  return nodes;
}

visualization_msgs::Marker makeNodeMarker(const MapSnapshot& snapshot) {
  const std::map<std::string, RobotColor> colors = robotColors(snapshot);
  auto marker = makeMarker("keyframes", visualization_msgs::Marker::SPHERE_LIST, kNodeSize);
  for (const MapSnapshot::Node& node : snapshot.nodes) {
    marker.points.push_back(positionOf(node.T_map_camera));
    marker.colors.push_back(makeColor(colors.at(node.keyframe->id.robot), 1.0F));
  }
  return marker;
}

std_msgs::ColorRGBA colorOf(const GraphEdge& edge,
                            const std::map<std::string, RobotColor>& colors) {
  if (edge.kind == EdgeKind::kOdometry) return makeColor(colors.at(edge.from.robot), 1.0F);
  if (edge.kind == EdgeKind::kHistory) return kHistoryColor;
  if (edge.kind == EdgeKind::kCoplanar) return kCoplanarColor;
  return edge.inter_robot ? kInterRobotColor : kClosureColor;
}

/// A list of lines for each kind of edge.
std::vector<visualization_msgs::Marker> makeEdgeMarkers(const MapSnapshot& snapshot) {
  const Nodes nodes = indexNodes(snapshot);
  const std::map<std::string, RobotColor> colors = robotColors(snapshot);
  const int lines = visualization_msgs::Marker::LINE_LIST;
  std::vector<visualization_msgs::Marker> markers = {
      makeMarker("odometry", lines, 0.04), makeMarker("history", lines, 0.008),
      makeMarker("closures", lines, 0.03), makeMarker("coplanar", lines, 0.015)};
  for (const GraphEdge& edge : snapshot.edges) {
    const auto from = nodes.find(edge.from);
    const auto to = nodes.find(edge.to);
    if (from == nodes.end() || to == nodes.end()) continue;
    visualization_msgs::Marker& marker = markers.at(static_cast<std::size_t>(edge.kind));
    for (const MapSnapshot::Node* node : {from->second, to->second}) {
      marker.points.push_back(positionOf(node->T_map_camera));
      marker.colors.push_back(colorOf(edge, colors));
    }
  }
  return markers;
}

/// The two triangles of a tile in the camera's frame.
struct Patch {
  const geometry_msgs::Point* points;  ///< six
  Eigen::Vector3d centre;
  Eigen::Vector3d normal;  ///< towards the camera
};

Patch patchAt(const geometry_msgs::Point* points) {
  const auto corner = [&](int i) { return Eigen::Vector3d(points[i].x, points[i].y, points[i].z); };
  Patch patch{points, 0.5 * (corner(0) + corner(2)), Eigen::Vector3d::UnitZ()};
  patch.normal = (corner(1) - corner(0)).cross(corner(2) - corner(0)).normalized();
  if (patch.normal.dot(patch.centre) > 0.0) patch.normal = -patch.normal;
  return patch;
}

/// Walls in the robot's colour, lit from one side; floors pale, so that what stands on them shows.
std_msgs::ColorRGBA shade(const std_msgs::ColorRGBA& color, const Eigen::Vector3d& normal_in_map) {
  const Eigen::Vector3d light(0.48, 0.64, 0.6);
  const auto brightness = static_cast<float>(0.8 + 0.2 * normal_in_map.dot(light));
  const auto paleness = static_cast<float>(0.7 * std::pow(std::abs(normal_in_map.z()), 4));
  std_msgs::ColorRGBA shaded = color;
  for (float* channel : {&shaded.r, &shaded.g, &shaded.b}) {
    *channel = brightness * ((1.0F - paleness) * *channel + paleness);
  }
  return shaded;
}

bool isShown(const MapSnapshot::Node& node, const Patch& patch, const PlaneMapView& view) {
  const double height = node.T_map_camera.linear().row(2) * patch.centre;
  const double incidence = -patch.normal.dot(patch.centre.normalized());
  return height <= view.max_height && incidence >= kMinIncidence;
}

}  // namespace

bool PlaneMapMarkers::isUpToDate(const MapSnapshot::Node& node) const {
  const auto shown = shown_.find(node.keyframe->id);
  if (shown == shown_.end() || shown->second.joined != (node.component == 0)) return false;
  const Eigen::Isometry3d T_shown_now = shown->second.T_map_camera.inverse() * node.T_map_camera;
  return T_shown_now.translation().norm() < kVisibleMove &&
         rotationAngle(T_shown_now) < kVisibleRotation;
}

visualization_msgs::Marker PlaneMapMarkers::makeMarker(const MapSnapshot::Node& node,
                                                       const RobotColor& color) const {
  const std_msgs::ColorRGBA robot_color =
      makeColor(color, node.component == 0 ? kJoinedAlpha : kSeparateAlpha);
  const KeyframeColors texture = view_.coloring == MapColoring::kTexture
                                     ? KeyframeColors(*node.keyframe->keyframe)
                                     : KeyframeColors();
  const std::vector<geometry_msgs::Point> corners =
      tileTriangles(*node.keyframe->planes, view_.max_depth);
  visualization_msgs::Marker marker = makeTriangleMarker({}, robot_color);
  for (std::size_t i = 0; i + 6 <= corners.size(); i += 6) {
    const Patch patch = patchAt(&corners[i]);
    if (!isShown(node, patch, view_)) continue;
    marker.points.insert(marker.points.end(), patch.points, patch.points + 6);
    // One for each triangle: rviz then leaves the lighting to us and shows both sides of a wall.
    const std_msgs::ColorRGBA patch_color =
        texture.empty() ? shade(robot_color, node.T_map_camera.linear() * patch.normal)
                        : makeColor(texture.at(patch.centre, color), robot_color.a);
    marker.colors.insert(marker.colors.end(), 2, patch_color);
  }
  if (marker.points.empty()) marker.action = visualization_msgs::Marker::DELETE;
  marker.pose = toPoseMessage(node.T_map_camera);
  marker.ns = node.keyframe->id.robot;
  return marker;
}

visualization_msgs::MarkerArray PlaneMapMarkers::update(const MapSnapshot& snapshot,
                                                        const std_msgs::Header& header) {
  if (snapshot.nodes.size() < shown_.size()) forget();
  visualization_msgs::MarkerArray markers;
  if (std::exchange(begins_, false)) markers.markers.push_back(makeDeleteAll(header));
  const std::map<std::string, RobotColor> colors = robotColors(snapshot);
  for (const MapSnapshot::Node& node : snapshot.nodes) {
    if (isUpToDate(node)) continue;
    const KeyframeId& id = node.keyframe->id;
    const auto [shown, is_new] = shown_.try_emplace(id);
    if (is_new) shown->second.id = static_cast<int>(shown_.size());
    shown->second.T_map_camera = node.T_map_camera;
    shown->second.joined = node.component == 0;
    markers.markers.push_back(makeMarker(node, colors.at(id.robot)));
    markers.markers.back().header = header;
    markers.markers.back().id = shown->second.id;
  }
  return markers;
}

visualization_msgs::MarkerArray makeGraphMarkers(const MapSnapshot& snapshot,
                                                 const std_msgs::Header& header) {
  visualization_msgs::MarkerArray markers;
  markers.markers = makeEdgeMarkers(snapshot);
  markers.markers.push_back(makeNodeMarker(snapshot));
  for (visualization_msgs::Marker& marker : markers.markers) {
    marker.header = header;
    if (marker.points.empty()) marker.action = visualization_msgs::Marker::DELETE;
  }
  return markers;
}

visualization_msgs::MarkerArray makeRejectedMarkers(const MapSnapshot& snapshot,
                                                    const std_msgs::Header& header) {
  const Nodes nodes = indexNodes(snapshot);
  std::map<std::string, visualization_msgs::Marker> by_reason;
  for (const RejectedClosure& rejected : snapshot.rejected) {
    const auto [entry, is_new] = by_reason.try_emplace(rejected.reason);
    visualization_msgs::Marker& marker = entry->second;
    if (is_new) {
      marker = makeMarker(rejected.reason, visualization_msgs::Marker::LINE_LIST, kRejectedWidth);
      marker.header = header;
      marker.color = kRejectedColor;
    }
    for (const KeyframeId& end : {rejected.from, rejected.to}) {
      marker.points.push_back(positionOf(nodes.at(end)->T_map_camera));
    }
  }
  visualization_msgs::MarkerArray markers;
  markers.markers.push_back(makeDeleteAll(header));
  for (auto& [reason, marker] : by_reason) markers.markers.push_back(std::move(marker));
  return markers;
}

std::map<std::string, nav_msgs::Path> makePaths(const MapSnapshot& snapshot,
                                                const std_msgs::Header& header) {
  std::map<std::string, nav_msgs::Path> paths;
  for (const MapSnapshot::Node& node : snapshot.nodes) {
    if (node.component != 0) continue;
    nav_msgs::Path& path = paths[node.keyframe->id.robot];
    path.header = header;
    geometry_msgs::PoseStamped pose;
    pose.header.frame_id = header.frame_id;
    pose.header.stamp = ros::Time(node.keyframe->stamp);
    pose.pose = toPoseMessage(node.T_map_camera);
    path.poses.push_back(std::move(pose));
  }
  return paths;
}

}  // namespace planecloud

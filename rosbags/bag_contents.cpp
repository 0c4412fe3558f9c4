// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/rosbags/bag_contents.h"

#include <algorithm>
#include <map>
#include <stdexcept>

namespace planecloud {
namespace {

bool contains(const std::string& text, const char* part) {
  return text.find(part) != std::string::npos;
}

/// "/robot1/camera/rgb" for "/robot1/camera/rgb/image_color"; empty at the root.
std::string parentOf(const std::string& topic) {
  const std::size_t slash = topic.rfind('/');
  return slash == std::string::npos ? std::string() : topic.substr(0, slash);
}

bool hasTopic(const std::vector<BagTopic>& topics, const std::string& name, const char* type) {
  return std::any_of(topics.begin(), topics.end(), [&](const BagTopic& topic) {
    return topic.name == name && topic.type == type;
  });
}

bool isDepth(const std::string& topic) { return contains(topic, "depth"); }
bool isColor(const std::string& topic) {
  return !isDepth(topic) && (contains(topic, "rgb") || contains(topic, "color"));
}

int rankOfColor(const std::string& topic) {
  return (contains(topic, "rect") ? 4 : 0) + (contains(topic, "color") ? 2 : 0);
}
int rankOfDepth(const std::string& topic) {
  return (contains(topic, "registered") ? 4 : 0) + (contains(topic, "rect") ? 2 : 0) +
         (contains(topic, "image") ? 1 : 0);
}

/// Images of one camera, best first.
struct CameraImages {
  std::vector<std::string> colors;
  std::vector<std::string> depths;
};

std::map<std::string, CameraImages> findCameras(const std::vector<BagTopic>& topics) {
  std::map<std::string, CameraImages> cameras;
  for (const BagTopic& topic : topics) {
    if (topic.type != "sensor_msgs/Image") continue;
    CameraImages& camera = cameras[parentOf(parentOf(topic.name))];
    if (isDepth(topic.name)) camera.depths.push_back(topic.name);
    if (isColor(topic.name)) camera.colors.push_back(topic.name);
  }
  const auto sortBy = [](std::vector<std::string>& names, int (*rank)(const std::string&)) {
    std::stable_sort(names.begin(), names.end(),
                     [&](const std::string& a, const std::string& b) { return rank(a) > rank(b); });
  };
  for (auto& [name, camera] : cameras) {
    sortBy(camera.colors, rankOfColor);
    sortBy(camera.depths, rankOfDepth);
  }
  return cameras;
}

/// The namespace a camera stands in: "robot1" for "/robot1/camera" and for "/robot1".
std::string robotNameOf(const std::string& camera) {
  const std::string last = camera.substr(camera.rfind('/') + 1);
  const std::string space = contains(last, "camera") ? parentOf(camera) : camera;
  std::string name = space.empty() ? "robot1" : space.substr(1);
  std::replace(name.begin(), name.end(), '/', '_');
  return name;
}

std::string groundTruthOf(const std::string& camera, const std::vector<BagTopic>& topics) {
  for (const std::string& space : {camera, parentOf(camera)}) {
    const std::string name = space + "/ground_truth";
    if (hasTopic(topics, name, "geometry_msgs/PoseStamped")) return name;
  }
  return {};
}

[[noreturn]] void refuseBag(const std::string& path, const std::vector<BagTopic>& topics) {
  std::string text = "'" + path +
                     "' has no camera with colour and depth images (sensor_msgs/Image on "
                     "<camera>/rgb/... or <camera>/color/... and on <camera>/depth_registered/... "
                     "or <camera>/depth/...): record those topics or rename them with rosbag "
                     "filter; it has";
  for (const BagTopic& topic : topics) text += " " + topic.name;
  throw std::runtime_error(topics.empty() ? text + " no topics" : text);
}

std::string cameraInfoOf(const std::string& path, const std::string& color,
                         const std::vector<BagTopic>& topics) {
  const std::string name = parentOf(color) + "/camera_info";
  if (hasTopic(topics, name, "sensor_msgs/CameraInfo")) return name;
  throw std::runtime_error("'" + path + "' has no camera_info for " + color + ": record " + name +
                           " as well");
}

}  // namespace

std::vector<RobotTopics> findRobots(const std::string& path, const std::vector<BagTopic>& topics) {
  std::vector<RobotTopics> robots;
  for (const auto& [camera, images] : findCameras(topics)) {
    if (images.colors.empty() || images.depths.empty()) continue;
    RobotTopics robot;
    robot.robot = robotNameOf(camera);
    robot.color = images.colors.front();
    robot.depth = images.depths.front();
    robot.camera_info = cameraInfoOf(path, robot.color, topics);
    robot.ground_truth = groundTruthOf(camera, topics);
    robots.push_back(robot);
  }
  if (robots.empty()) refuseBag(path, topics);
  return robots;
}

}  // namespace planecloud

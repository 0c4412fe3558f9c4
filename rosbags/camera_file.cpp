// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/rosbags/camera_file.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "planecloud_slam/rosbags/usage_error.h"

namespace planecloud {
namespace {

template <typename Value>
Value readKey(const YAML::Node& root, const std::string& path, const std::string& key) {
  if (!root[key]) throw std::runtime_error(path + ": " + key + " is missing");
  try {
    return root[key].as<Value>();
  } catch (const YAML::Exception&) {
    throw std::runtime_error(path + ": " + key + " has a value of the wrong type");
  }
}

void refuseUnknownKeys(const YAML::Node& root, const std::string& path) {
  constexpr std::array<const char*, 8> kKnown = {"fx",         "fy",    "cx",     "cy",
                                                 "distortion", "width", "height", "depth_scale"};
  for (const auto& entry : root) {
    const auto key = entry.first.as<std::string>();
    if (std::find(kKnown.begin(), kKnown.end(), key) == kKnown.end()) {
      throw std::runtime_error(path + ": unknown key '" + key +
                               "'; known are fx, fy, cx, cy, distortion, width, height, "
                               "depth_scale");
    }
  }
}

void readDistortion(const YAML::Node& root, const std::string& path, CameraIntrinsics& camera) {
  const auto values = readKey<std::vector<double>>(root, path, "distortion");
  if (values.size() > camera.distortion.size()) {
    throw std::runtime_error(path + ": distortion has " + std::to_string(values.size()) +
                             " values; at most 5 are known: k1, k2, p1, p2, k3");
  }
  std::copy(values.begin(), values.end(), camera.distortion.begin());
}

}  // namespace

CameraFile readCameraFile(const std::string& path) {
  YAML::Node root;
  try {
    root = YAML::LoadFile(path);
  } catch (const YAML::Exception& error) {
    throw std::runtime_error(path + ": " + error.what());
  }
  if (!root.IsMap()) throw std::runtime_error(path + ": expected 'key: value' lines");
  refuseUnknownKeys(root, path);
  CameraFile file;
  file.camera.fx = readKey<double>(root, path, "fx");
  file.camera.fy = readKey<double>(root, path, "fy");
  file.camera.cx = readKey<double>(root, path, "cx");
  file.camera.cy = readKey<double>(root, path, "cy");
  if (root["distortion"]) readDistortion(root, path, file.camera);
  if (root["width"] || root["height"]) {
    file.camera.width = readKey<int>(root, path, "width");
    file.camera.height = readKey<int>(root, path, "height");
  }
  if (root["depth_scale"]) file.depth_scale = readKey<double>(root, path, "depth_scale");
  return file;
}

CameraIntrinsics parseCameraFlag(const std::string& text) {
  std::vector<double> values;
  const std::string wrong =
      "--camera " + text + ": expected numbers fx,fy,cx,cy[,k1,k2,p1,p2,k3], separated by commas";
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string word = text.substr(begin, end - begin);
    std::size_t used = 0;
    double value = 0.0;
    try {
      value = std::stod(word, &used);
    } catch (const std::exception&) {
      throw UsageError(wrong);
    }
    if (used != word.size() || !std::isfinite(value)) throw UsageError(wrong);
    values.push_back(value);
    begin = end + 1;
  }
  if (values.size() < 4 || values.size() > 9) throw UsageError(wrong);
  if (values[0] <= 0.0 || values[1] <= 0.0) {
    throw UsageError("--camera " + text + ": fx and fy must be above 0");
  }
  CameraIntrinsics camera;
  camera.fx = values[0];
  camera.fy = values[1];
  camera.cx = values[2];
  camera.cy = values[3];
  std::copy(values.begin() + 4, values.end(), camera.distortion.begin());
  return camera;
}

}  // namespace planecloud

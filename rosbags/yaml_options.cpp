// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/rosbags/yaml_options.h"

#include <yaml-cpp/yaml.h>

#include <stdexcept>

namespace planecloud {
namespace {

std::string placeOf(const std::string& path, const YAML::Node& node) {
  return path + ":" + std::to_string(node.Mark().line + 1);
}

void flatten(const std::string& path, const YAML::Node& map, const std::string& prefix,
             OptionValues& values) {
  for (const auto& entry : map) {
    const std::string key = prefix + entry.first.as<std::string>();
    if (entry.second.IsMap()) {
      flatten(path, entry.second, key + "/", values);
    } else if (entry.second.IsScalar()) {
      if (!values.emplace(key, entry.second.Scalar()).second) {
        throw std::runtime_error(placeOf(path, entry.first) + ": " + key + " is given twice");
      }
    } else {
      throw std::runtime_error(placeOf(path, entry.first) + ": " + key +
                               " must have one value or keys below it");
    }
  }
}

/// Sets `a/b/c` below `root`, making the maps on the way.
void setNested(YAML::Node root, const std::string& key, const std::string& text) {
  const std::size_t slash = key.find('/');
  if (slash == std::string::npos) {
    root[key] = text;
  } else {
    setNested(root[key.substr(0, slash)], key.substr(slash + 1), text);
  }
}

}  // namespace

OptionValues readYamlOptions(const std::string& path) {
  YAML::Node root;
  try {
    root = YAML::LoadFile(path);
  } catch (const YAML::BadFile&) {
    throw std::runtime_error("cannot read '" + path + "'");
  } catch (const YAML::Exception& error) {
    throw std::runtime_error(path + ":" + std::to_string(error.mark.line + 1) + ": " + error.msg);
  }
  OptionValues values;
  if (root.IsNull()) return values;
  if (!root.IsMap()) throw std::runtime_error(path + ": expected 'key: value' lines");
  flatten(path, root, "", values);
  return values;
}

std::string formatYamlOptions(const OptionValues& values) {
  YAML::Node root(YAML::NodeType::Map);
  for (const auto& [key, text] : values) setNested(root, key, text);
  YAML::Emitter emitter;
  emitter << root;
  return std::string(emitter.c_str()) + "\n";
}

void refuseUnknownOptions(const OptionValues& unknown, const OptionValues& known) {
  if (unknown.empty()) return;
  const std::string& key = unknown.begin()->first;
  throw std::invalid_argument("unknown key '" + key + "'; nearest known is '" +
                              nearestKey(key, known) + "'");
}

}  // namespace planecloud

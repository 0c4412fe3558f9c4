// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/rosbags/replay_config.h"

#include <algorithm>
#include <cstddef>
#include <set>

#include "planecloud_slam/rosbags/yaml_options.h"

namespace planecloud {
namespace {

std::string sectionOf(const std::string& key) { return key.substr(0, key.find('/')); }

/// How many of `values` belong to a part that has options among `known`, misspelt ones included.
std::ptrdiff_t countOfParts(const OptionValues& values, const OptionValues& known) {
  std::set<std::string> sections;
  for (const auto& [key, text] : known) sections.insert(sectionOf(key));
  return std::count_if(values.begin(), values.end(), [&](const auto& value) {
    return sections.count(sectionOf(value.first)) > 0;
  });
}

}  // namespace

void loadConfig(const std::string& path, ReplayConfig& config) {
  const OptionValues values = readYamlOptions(path);
  const std::ptrdiff_t of_frontend = countOfParts(values, dumpOptions(config.frontend));
  const std::ptrdiff_t of_backend = countOfParts(values, dumpOptions(config.backend));
  if (of_backend > of_frontend) {
    loadYamlOptions(path, config.backend);
  } else {
    loadYamlOptions(path, config.frontend);
  }
}

}  // namespace planecloud

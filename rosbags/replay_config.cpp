// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/rosbags/replay_config.h"

#include "planecloud_slam/rosbags/yaml_options.h"

namespace planecloud {
namespace {

std::size_t countKnown(const OptionValues& values, const OptionValues& known) {
  std::size_t count = 0;
  for (const auto& [key, text] : values) count += known.count(key);
  return count;
}

}  // namespace

void loadConfig(const std::string& path, ReplayConfig& config) {
  const OptionValues values = readYamlOptions(path);
  const std::size_t of_frontend = countKnown(values, dumpOptions(config.frontend));
  const std::size_t of_backend = countKnown(values, dumpOptions(config.backend));
  if (of_backend > of_frontend) {
    loadYamlOptions(path, config.backend);
  } else {
    loadYamlOptions(path, config.frontend);
  }
}

}  // namespace planecloud

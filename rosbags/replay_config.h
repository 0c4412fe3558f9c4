// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "planecloud_slam/backend_node/backend_node_options.h"
#include "planecloud_slam/frontend_node/frontend_node_options.h"

namespace planecloud {

/// Options of both sides, as the nodes have them.
struct ReplayConfig {
  FrontendNodeOptions frontend;
  BackendNodeOptions backend;
};

/// Reads a YAML file of the frontend's or of the backend's parameters; its keys tell which. Throws
/// std::runtime_error or std::invalid_argument naming the file, the key and what is wrong with it.
void loadConfig(const std::string& path, ReplayConfig& config);

}  // namespace planecloud

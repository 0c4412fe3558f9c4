// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

namespace planecloud {

/// Initialises ROS so that SIGINT and SIGTERM leave the node connected until `run` returns, and
/// serves its callbacks in two threads meanwhile. Returns the exit code: 1, with one fatal message,
/// when `run` throws.
int runNode(int argc, char** argv, const std::string& name, const std::function<void()>& run);

/// Returns at SIGINT, SIGTERM or when ROS shuts down.
void spinUntilStopped();

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace planecloud {

/// Robot names become parts of topics, frames and file names: 1 to 64 letters, digits, `_` or `-`.
[[nodiscard]] bool isRobotName(const std::string& name);

/// What is wrong with a name that is none, fit for a log whatever its bytes.
[[nodiscard]] std::string robotNameError(const std::string& name);

/// Throws std::invalid_argument with `robotNameError`.
void checkRobotName(const std::string& name);

}  // namespace planecloud

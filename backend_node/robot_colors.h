// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "planecloud_slam/backend_node/map_snapshot.h"

namespace planecloud {

/// Red, green, blue [0, 255].
struct RobotColor {
  std::uint8_t r = 0;
  std::uint8_t g = 0;
  std::uint8_t b = 0;
};

/// The colour of each robot in every picture of the map: the palette in order of the robots' names,
/// from its start again when there are more robots than colours.
[[nodiscard]] std::map<std::string, RobotColor> robotColors(const MapSnapshot& snapshot);

}  // namespace planecloud

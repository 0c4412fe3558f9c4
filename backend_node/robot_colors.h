// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>

#include "planecloud_slam/backend_node/map_snapshot.h"
#include "planecloud_slam/plane_fit/rgb8.h"

namespace planecloud {

using RobotColor = Rgb8;

/// The colour of each robot in every picture of the map: the palette in order of the robots' names,
/// from its start again when there are more robots than colours.
[[nodiscard]] std::map<std::string, RobotColor> robotColors(const MapSnapshot& snapshot);

}  // namespace planecloud

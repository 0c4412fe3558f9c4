// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/backend_node/map_coloring.h"

#include <stdexcept>

namespace planecloud {

std::string toString(MapColoring coloring) {
  switch (coloring) {
    case MapColoring::kRobot:
      return "robot";
    case MapColoring::kTexture:
      return "texture";
  }
  throw std::invalid_argument("unknown coloring of the map");
}

void fromString(const std::string& text, MapColoring& coloring) {
  for (const MapColoring choice : {MapColoring::kRobot, MapColoring::kTexture}) {
    if (toString(choice) != text) continue;
    coloring = choice;
    return;
  }
  throw std::invalid_argument("map_coloring = " + text + ": must be one of robot, texture");
}

}  // namespace planecloud

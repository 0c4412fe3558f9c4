// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace planecloud {

/// What the surfaces of the map are painted with.
enum class MapColoring {
  kRobot,    ///< a colour for each robot
  kTexture,  ///< what the cameras saw; the robot's colour where there is no texture
};
[[nodiscard]] std::string toString(MapColoring coloring);
/// Throws std::invalid_argument naming the choices.
void fromString(const std::string& text, MapColoring& coloring);

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/backend_node/robot_colors.h"

#include <array>

namespace planecloud {
namespace {

/// Okabe and Ito's palette, told apart by colour-blind people as well.
constexpr std::array<RobotColor, 7> kPalette{{{230, 159, 0},
                                              {86, 180, 233},
                                              {0, 158, 115},
                                              {204, 121, 167},
                                              {213, 94, 0},
                                              {0, 114, 178},
                                              {240, 228, 66}}};

}  // namespace

std::map<std::string, RobotColor> robotColors(const MapSnapshot& snapshot) {
  std::map<std::string, RobotColor> colors;
  for (const MapSnapshot::Node& node : snapshot.nodes) colors[node.keyframe->id.robot];
  std::size_t next = 0;
  for (auto& [robot, color] : colors) color = kPalette[next++ % kPalette.size()];
  return colors;
}

}  // namespace planecloud

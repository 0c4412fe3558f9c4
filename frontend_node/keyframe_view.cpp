// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/frontend_node/keyframe_view.h"

#include <cmath>
#include <limits>

#include "planecloud_slam/plane_fit/appearance_descriptor.h"

namespace planecloud {
namespace {

/// Narrower images leave too few pixels in a descriptor's cell.
constexpr int kDescribedWidth = 80;

const RgbdLevel& describedLevel(const RgbdPyramid& pyramid) {
  const std::vector<RgbdLevel>& levels = pyramid.levels();
  for (std::size_t i = levels.size(); i-- > 1;) {
    if (levels[i].camera.width >= kDescribedWidth) return levels[i];
  }
  return levels.front();
}

}  // namespace

std::vector<std::uint8_t> describeView(const RgbdPyramid& pyramid) {
  const RgbdLevel& level = describedLevel(pyramid);
  Image<std::uint8_t> grey(level.camera.width, level.camera.height);
  Image<float> depth(level.camera.width, level.camera.height);
  const GreyDepth* pixel = level.pixels.begin();
  for (std::size_t i = 0; i < grey.size(); ++i, ++pixel) {
    grey.begin()[i] = static_cast<std::uint8_t>(std::lround(pixel->grey));
    depth.begin()[i] = pixel->inverse_depth > 0.0F ? 1.0F / pixel->inverse_depth
                                                   : std::numeric_limits<float>::quiet_NaN();
  }
  return makeAppearanceDescriptor(grey.view(), depth.view());
}

Eigen::Isometry3d turnByShift(const LevelCamera& camera, double shift_x, double shift_y) {
  const double right = std::atan(shift_x * camera.width / camera.fx);
  const double down = std::atan(shift_y * camera.height / camera.fy);
  Eigen::Isometry3d turn = Eigen::Isometry3d::Identity();
  turn.linear() = (Eigen::AngleAxisd(right, Eigen::Vector3d::UnitY()) *
                   Eigen::AngleAxisd(-down, Eigen::Vector3d::UnitX()))
                      .toRotationMatrix();
  return turn;
}

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/frontend_node/grey_motion_scalar.h"

namespace planecloud {

Image<float> greyOf(const RgbdLevel& level) {
  Image<float> grey(level.camera.width, level.camera.height);
  for (std::size_t i = 0; i < grey.size(); ++i) grey.begin()[i] = level.pixels.begin()[i].grey;
  return grey;
}

void moveGrey(const Eigen::Isometry3d& T_color_depth, ImageView<float> grey, RgbdLevel& level) {
  const LevelCamera& camera = level.camera;
  const GreyMotion motion{T_color_depth.linear().cast<float>(),
                          T_color_depth.translation().cast<float>(), camera};
  for (int y = 0; y < camera.height; ++y) {
    vectorMoveGreyRow()(motion, grey, y, level.pixels.row(y));
  }
}

MoveGreyRow scalarMoveGreyRow() {
  return [](const GreyMotion& motion, ImageView<float> grey, int y, GreyDepth* pixels) {
    scalar::moveGreyRow(motion, grey, y, 0, pixels);
  };
}

#ifndef PLANECLOUD_SLAM_HAVE_HIGHWAY
MoveGreyRow vectorMoveGreyRow() { return scalarMoveGreyRow(); }
#endif

}  // namespace planecloud

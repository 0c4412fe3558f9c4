// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include "planecloud_slam/frontend_node/rgbd_pyramid.h"

namespace planecloud {

/// Colour and depth images of a pair are taken up to half a frame apart. Gives the pixels of
/// `level` the grey values of `grey`, an image of its size, as seen from where its depth was taken:
/// `T_color_depth` is the small motion of the camera in between. Pixels without depth count as far
/// away; those that were outside the colour image repeat its border.
void moveGrey(const Eigen::Isometry3d& T_color_depth, ImageView<float> grey, RgbdLevel& level);

/// The grey values of a level.
[[nodiscard]] Image<float> greyOf(const RgbdLevel& level);

/// The same motion in the precision of the loop.
struct GreyMotion {
  Eigen::Matrix3f R = Eigen::Matrix3f::Identity();  ///< of T_color_depth
  Eigen::Vector3f t = Eigen::Vector3f::Zero();      ///< [m]
  LevelCamera camera;
};

/// Gives the pixels of row `y` the grey values of `grey`, which is the whole image before it moved.
/// Two implementations that agree to rounding.
using MoveGreyRow = void (*)(const GreyMotion& motion, ImageView<float> grey, int y,
                             GreyDepth* pixels);
[[nodiscard]] MoveGreyRow scalarMoveGreyRow();
/// The best this processor has; the scalar one when built without Highway.
[[nodiscard]] MoveGreyRow vectorMoveGreyRow();

}  // namespace planecloud

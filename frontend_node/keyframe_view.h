// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <vector>

#include "planecloud_slam/frontend_node/rgbd_pyramid.h"
#include "planecloud_slam/frontend_node/tracking_reference.h"
#include "planecloud_slam/plane_fit/keyframe.h"

namespace planecloud {

/// What is kept of a keyframe to align other images with it.
struct KeyframeView {
  KeyframeId id;
  int segment = 0;  ///< odometry poses of different segments are unrelated
  Eigen::Isometry3d T_odom_camera = Eigen::Isometry3d::Identity();
  RgbdPyramid pyramid;
  std::vector<std::uint8_t> descriptor;  ///< of `describeView`
};

/// Immutable, shared between threads.
using KeyframeViewPtr = std::shared_ptr<const KeyframeView>;

/// The appearance descriptor of a pyramid's small image: comparable with that of other pyramids of
/// the same shape. Much cheaper than that of the full images.
[[nodiscard]] std::vector<std::uint8_t> describeView(const RgbdPyramid& pyramid);

/// Motions T_view_live for which the live image would look like the view does: turned as the shift
/// between their descriptors says.
[[nodiscard]] Eigen::Isometry3d turnByShift(const LevelCamera& camera, double shift_x,
                                            double shift_y);

/// A completed keyframe with the earlier ones that it may be aligned with, for another thread.
struct HistoryTask {
  KeyframeViewPtr view;                                ///< none: nothing to do
  std::shared_ptr<const TrackingReference> reference;  ///< of `view`
  std::vector<KeyframeViewPtr> earlier;                ///< oldest first
};

}  // namespace planecloud

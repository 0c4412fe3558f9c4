// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <geometry_msgs/Pose.h>
#include <geometry_msgs/Transform.h>

#include <Eigen/Geometry>

#include "planecloud_slam/planecloud_msgs/message_error.h"

namespace planecloud {

/// `T_frame_body` as the pose of `body` in `frame`.
[[nodiscard]] geometry_msgs::Pose toPoseMessage(const Eigen::Isometry3d& T_frame_body);

/// `T_target_source` as tf has it: header.frame_id is the target, child_frame_id the source.
[[nodiscard]] geometry_msgs::Transform toTransformMessage(const Eigen::Isometry3d& T_target_source);

/// Throws MessageError when a number is not finite or the quaternion's norm is not 1 within 1 %.
[[nodiscard]] Eigen::Isometry3d fromMessage(const geometry_msgs::Pose& pose);
[[nodiscard]] Eigen::Isometry3d fromMessage(const geometry_msgs::Transform& transform);

}  // namespace planecloud

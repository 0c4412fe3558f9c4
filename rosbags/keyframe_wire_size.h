// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

#include "planecloud_slam/plane_fit/keyframe.h"

namespace planecloud {

/// Optical frame that `keyframeWireSize` counts: the usual one of OpenNI cameras.
constexpr const char* kUsualOpticalFrame = "camera_rgb_optical_frame";

/// Bytes of the keyframe as a PlaneCloudKeyframe message, all fields counted (ROS 1 serialisation,
/// planecloud_msgs/msg), so that tools without ROS report what a link would carry.
[[nodiscard]] std::size_t keyframeWireSize(const Keyframe& keyframe,
                                           const std::string& frame_id = kUsualOpticalFrame);

}  // namespace planecloud

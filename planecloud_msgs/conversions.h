// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <planecloud_slam/PlaneCloudKeyframe.h>

#include <string>

#include "planecloud_slam/plane_fit/keyframe.h"
#include "planecloud_slam/plane_fit/plane_cloud.h"
#include "planecloud_slam/planecloud_msgs/message_error.h"

/// Core types to messages and back. What a message says is specified in planecloud_msgs/README.md.
/// Nothing received is trusted: `fromMessage` throws MessageError, and what it returns has finite
/// numbers, valid intrinsics, known encodings and counts that the image can hold. The coded planes
/// themselves are checked by `decode`.
namespace planecloud {

/// `frame_id`: the camera's optical frame. Poses, intrinsics, information and statistics are
/// rounded as `asTravelled` says. Throws std::invalid_argument for a robot name that fails its
/// check, an unknown texture format, and intrinsics that fail theirs.
[[nodiscard]] planecloud_slam::PlaneCloudKeyframe toMessage(const Keyframe& keyframe,
                                                            const std::string& frame_id);

/// Equals `asTravelled(keyframe)` for every message made by `toMessage`.
[[nodiscard]] Keyframe fromMessage(const planecloud_slam::PlaneCloudKeyframe& message);

/// `stamp`: of the depth image [s since the epoch].
[[nodiscard]] planecloud_slam::PlaneCloud toMessage(const EncodedPlaneCloud& planes, double stamp,
                                                    const std::string& frame_id);

[[nodiscard]] EncodedPlaneCloud fromMessage(const planecloud_slam::PlaneCloud& message);

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "planecloud_slam/plane_fit/keyframe.h"
#include "planecloud_slam/plane_fit/plane_cloud.h"

namespace planecloud {

/// What a strict look at a received keyframe gives: its planes, or one reason to refuse it.
struct KeyframeCheck {
  std::shared_ptr<const PlaneCloud> planes;  ///< null when refused
  std::string reason;                        ///< for people, names the keyframe and the cure
};

/// Checks everything a keyframe from the network can get wrong: identity, stamp, poses, edges,
/// their information and the coded planes, which it decodes. Never throws for bad data.
[[nodiscard]] KeyframeCheck checkKeyframe(const Keyframe& keyframe);

}  // namespace planecloud

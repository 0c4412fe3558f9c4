// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "planecloud_slam/plane_fit/plane_cloud.h"
#include "planecloud_slam/plane_fit/se3.h"

namespace planecloud {

/// Identity of a keyframe in every graph: taken from the message, never from its topic.
struct KeyframeId {
  std::string robot;          ///< unique name of the robot, e.g. "robot1"
  std::uint64_t session = 0;  ///< start of the frontend's run [ns since the epoch]; later is newer
  std::uint32_t number = 0;   ///< counts from 0 without gaps within a session

  friend bool operator==(const KeyframeId& a, const KeyframeId& b) {
    return a.number == b.number && a.session == b.session && a.robot == b.robot;
  }
  friend bool operator!=(const KeyframeId& a, const KeyframeId& b) { return !(a == b); }
  friend bool operator<(const KeyframeId& a, const KeyframeId& b) {
    return std::tie(a.robot, a.session, a.number) < std::tie(b.robot, b.session, b.number);
  }
};

/// Whether both come from one run of one robot's frontend.
[[nodiscard]] inline bool sameSession(const KeyframeId& a, const KeyframeId& b) {
  return a.session == b.session && a.robot == b.robot;
}

/// `robot/session/number`, for logs.
[[nodiscard]] std::string toString(const KeyframeId& id);

/// A measured relative pose between the keyframe that carries it and another one.
struct RelativePoseEdge {
  KeyframeId other;
  Eigen::Isometry3d T_other_this = Eigen::Isometry3d::Identity();
  /// In the tangent space at `this` keyframe, order (translation, rotation) [1/m^2, 1/rad^2].
  Matrix6d information = Matrix6d::Identity();
};

/// Compressed texture of the keyframe, opaque to the core.
struct KeyframeTexture {
  std::string format;               ///< "" (none), "jpeg-grey" or "jpeg-color"
  std::vector<std::uint8_t> bytes;  ///< image file
};

/// What a frontend tells a backend about one completed keyframe.
struct Keyframe {
  KeyframeId id;
  double stamp = 0.0;  ///< of the depth image [s since the epoch]
  /// Pose of the camera's optical frame in the frontend's odometry frame.
  Eigen::Isometry3d T_odom_camera = Eigen::Isometry3d::Identity();
  EncodedPlaneCloud planes;
  /// First the keyframe it was tracked from: the previous one, or an earlier one found again. None
  /// at all begins a new segment of unknown relation.
  std::vector<RelativePoseEdge> edges;
  std::vector<KeyframeId> closure_hints;  ///< keyframes the frontend believes it sees again
  std::vector<std::uint8_t> descriptor;   ///< appearance, see appearance_descriptor.h; may be empty
  KeyframeTexture texture;
};

}  // namespace planecloud

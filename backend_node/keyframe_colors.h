// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "planecloud_slam/backend_node/map_coloring.h"
#include "planecloud_slam/plane_fit/camera.h"
#include "planecloud_slam/plane_fit/image_view.h"
#include "planecloud_slam/plane_fit/keyframe.h"
#include "planecloud_slam/plane_fit/rgb8.h"

namespace planecloud {

/// The texture of a keyframe, laid over its view.
class KeyframeColors {
 public:
  /// Without texture; so is one that cannot be decoded or is larger than the keyframe's image.
  KeyframeColors() = default;
  explicit KeyframeColors(const Keyframe& keyframe);

  [[nodiscard]] bool empty() const { return texture_.empty(); }

  /// Colour of the surface at `point` of the optical frame [m], bilinear; `otherwise` without
  /// texture.
  [[nodiscard]] Rgb8 at(const Eigen::Vector3d& point, const Rgb8& otherwise) const;

 private:
  CameraIntrinsics camera_;
  Image<Rgb8> texture_;
};

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "planecloud_slam/frontend_node/rectifier.h"
#include "planecloud_slam/frontend_node/rgbd_pyramid.h"

namespace planecloud {

/// The images of the current frame as tracking wants them, without lens distortion: what every
/// frame needs is made for every frame, what a keyframe needs only on request.
class LiveImages {
 public:
  /// `camera` as it takes the images. Throws std::invalid_argument when camera or options fail
  /// their check.
  LiveImages(const CameraIntrinsics& camera, const DenseTrackerOptions& options);

  /// Makes `pyramid` and `depth` of `frame`, of the camera's size. `T_color_depth`: see moveGrey.
  void assign(const RgbdFrame& frame,
              const Eigen::Isometry3d& T_color_depth = Eigen::Isometry3d::Identity());

  [[nodiscard]] const RgbdPyramid& pyramid() const { return pyramids_[current_]; }
  /// Keeps the pyramid of the frame assigned last until this is called again.
  void keep() { kept_ = current_; }
  /// The pyramid kept last; that of no frame when none was.
  [[nodiscard]] const RgbdPyramid& kept() const { return pyramids_[kept_]; }
  /// Depth [m, NaN: none] of `frame`, the one assigned last.
  [[nodiscard]] ImageView<float> depth(const RgbdFrame& frame) const;
  /// All images of `frame`, the one assigned last.
  [[nodiscard]] RgbdFrame full(const RgbdFrame& frame) const;

 private:
  std::optional<Rectifier> rectifier_;  ///< of a camera with distortion
  std::array<RgbdPyramid, 2> pyramids_;
  std::size_t current_ = 0;
  std::size_t kept_ = 0;
  RgbdFrame rectified_;     ///< keeps its memory
  Image<float> half_grey_;  ///< likewise
};

}  // namespace planecloud

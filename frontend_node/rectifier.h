// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "planecloud_slam/frontend_node/frontend.h"
#include "planecloud_slam/plane_fit/camera.h"

namespace planecloud {

/// Remaps image pairs of a camera with lens distortion to the same pinhole without it: grey values
/// bilinear, depths from the nearest pixel (no depth between two surfaces).
class Rectifier {
 public:
  /// Throws std::invalid_argument when `camera` fails its check.
  explicit Rectifier(const CameraIntrinsics& camera);
  ~Rectifier();
  Rectifier(Rectifier&&) noexcept;
  Rectifier& operator=(Rectifier&&) noexcept;

  /// The camera the rectified images belong to.
  [[nodiscard]] const CameraIntrinsics& camera() const { return rectified_; }

  /// Where the original image does not reach, depth is NaN. The frame must have the camera's size.
  [[nodiscard]] RgbdFrame rectify(const RgbdFrame& frame) const;
  /// The same into `rectified`, whose memory is kept.
  void rectify(const RgbdFrame& frame, RgbdFrame& rectified) const;

 private:
  struct Maps;
  CameraIntrinsics rectified_;
  std::unique_ptr<Maps> maps_;
};

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "planecloud_slam/frontend_node/frontend.h"
#include "planecloud_slam/plane_fit/camera.h"

namespace planecloud {

/// Remaps image pairs of a camera with lens distortion to the same pinhole without it: grey values
/// and colours bilinear, depths from the nearest pixel (no depth between two surfaces). Images must
/// have the camera's size; the memory of results is kept.
class Rectifier {
 public:
  /// Throws std::invalid_argument when `camera` fails its check.
  explicit Rectifier(const CameraIntrinsics& camera);
  ~Rectifier();
  Rectifier(Rectifier&&) noexcept;
  Rectifier& operator=(Rectifier&&) noexcept;

  /// The camera the rectified images belong to.
  [[nodiscard]] const CameraIntrinsics& camera() const { return rectified_; }

  /// All images of a frame.
  [[nodiscard]] RgbdFrame rectify(const RgbdFrame& frame) const;

  /// Depth [m] alone; NaN where the original image does not reach.
  void rectifyDepth(const Image<float>& depth, Image<float>& rectified) const;
  /// The mean grey value of each 2x2 rectified pixels, at a quarter of the cost of these.
  void rectifyHalfGrey(const Image<std::uint8_t>& grey, Image<float>& rectified) const;
  /// Grey and colour of `frame`; `rectified` keeps its depth.
  void rectifyColors(const RgbdFrame& frame, RgbdFrame& rectified) const;

 private:
  struct Maps;
  CameraIntrinsics rectified_;
  std::unique_ptr<Maps> maps_;
};

}  // namespace planecloud

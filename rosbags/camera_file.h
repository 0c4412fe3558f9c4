// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "planecloud_slam/plane_fit/camera.h"

namespace planecloud {

/// What a camera.yaml says: fx, fy, cx, cy [px], optional distortion [k1, k2, p1, p2, k3], optional
/// width and height [px] (0: not said) and depth_scale (depth pixels per metre).
struct CameraFile {
  CameraIntrinsics camera;
  std::optional<double> depth_scale;
};

/// Throws std::runtime_error naming file, key and what is wrong with it; unknown keys are errors.
[[nodiscard]] CameraFile readCameraFile(const std::string& path);

/// `fx,fy,cx,cy[,k1,k2,p1,p2,k3]` as a flag gives it, missing coefficients 0; width and height stay
/// 0. Throws UsageError.
[[nodiscard]] CameraIntrinsics parseCameraFlag(const std::string& text);

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "planecloud_slam/frontend_node/depth_fusion.h"
#include "planecloud_slam/plane_fit/camera.h"
#include "planecloud_slam/plane_fit/image_view.h"
#include "planecloud_slam/plane_fit/option_fields.h"

namespace planecloud {

/// How live frames update the depth of the open keyframe.
struct LocalMapOptions {
  bool fuse = true;           ///< false: the keyframe keeps the depth it was opened with
  double sigma = 0.006;       ///< standard deviation of one inverse depth [1/m], [1e-5, 1]
  double gate = 3.0;          ///< fuse within this many standard deviations, [0.5, 20]
  int interval = 2;           ///< every how many-th tracked frame is fused, [1, 100]
  int max_observations = 30;  ///< frames that count in a pixel's mean at most, [1, 255]

  template <typename Self, typename Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("fuse", self.fuse);
    visit("sigma", self.sigma);
    visit("gate", self.gate);
    visit("interval", self.interval);
    visit("max_observations", self.max_observations);
  }

  /// Throws std::invalid_argument naming key, value and range.
  void check() const;
};

/// The frontend's local map: one keyframe whose depth the live frames improve (paper sec. 3.1).
/// Every pixel is a Gaussian of inverse depth; a frame's depth enters where it agrees with it
/// within the gate, so occlusions and outliers stay outside. Pixels without depth take the first
/// they are shown.
class LocalMap {
 public:
  /// Throws std::invalid_argument when `options` or `camera` fail their check, or when the camera
  /// has distortion.
  LocalMap(const LocalMapOptions& options, const CameraIntrinsics& camera);

  /// Opens a keyframe with `depth` [m, NaN or <= 0: none] of the camera's size.
  void open(ImageView<float> depth);

  /// Fuses the `depth` of a frame at `T_keyframe_camera`; nothing when fusion is off.
  void fuse(ImageView<float> depth, const Eigen::Isometry3d& T_keyframe_camera);

  /// The keyframe's depth [m], NaN: none.
  [[nodiscard]] Image<float> depth() const;

 private:
  [[nodiscard]] FusionWarp warp(const Eigen::Isometry3d& T) const;
  [[nodiscard]] FusionRow row(int y) const;
  void fillHoles(ImageView<float> depth, const Eigen::Isometry3d& T_keyframe_camera);
  void improvePixels(ImageView<float> depth, const Eigen::Isometry3d& T_camera_keyframe);

  LocalMapOptions options_;
  CameraIntrinsics camera_;
  Image<float> inverse_depth_;        ///< mean [1/m], 0: none
  Image<std::uint8_t> observations_;  ///< frames in the mean
  int frames_ = 0;                    ///< offered to this keyframe
  std::vector<float> tangents_;       ///< of the columns
  std::vector<int> pixels_;           ///< of one row: where it is seen
  std::vector<float> seen_;           ///< of one row: its inverse depth there [1/m]
};

}  // namespace planecloud

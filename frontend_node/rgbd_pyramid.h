// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "planecloud_slam/frontend_node/dense_tracker_options.h"
#include "planecloud_slam/frontend_node/pyramid_kernels.h"
#include "planecloud_slam/plane_fit/camera.h"
#include "planecloud_slam/plane_fit/image_view.h"

namespace planecloud {

/// A pinhole camera without distortion at the resolution of one pyramid level.
struct LevelCamera {
  int width = 0;
  int height = 0;
  float fx = 0.0F;
  float fy = 0.0F;
  float cx = 0.0F;
  float cy = 0.0F;
};

/// The camera after `halvings` averagings of 2x2 pixels: pixel centres move by half a pixel.
[[nodiscard]] LevelCamera levelCamera(const CameraIntrinsics& camera, int halvings);

/// One resolution of an image pair.
struct RgbdLevel {
  LevelCamera camera;
  Image<GreyDepth> pixels;
};

/// Resolutions of one image pair, each half the one before. Grey values are averaged; depths are
/// averaged only within one surface, the nearer one at a depth edge, so that no depth lies between
/// two surfaces. Inverse depth is what is kept: its noise is the same at every distance.
class RgbdPyramid {
 public:
  /// Throws std::invalid_argument when `camera` or `options` fail their check, when the camera
  /// has distortion or when the coarsest level would be smaller than 16 x 12 pixels.
  RgbdPyramid(const CameraIntrinsics& camera, const DenseTrackerOptions& options);

  /// Rebuilds every level from `grey` [0..255] and `depth` [m, NaN: none], both of the camera's
  /// size; depths outside the options' range count as none. Keeps the memory.
  /// `T_color_depth`: motion of the camera between the two, see moveGrey.
  void assign(ImageView<std::uint8_t> grey, ImageView<float> depth,
              const Eigen::Isometry3d& T_color_depth = Eigen::Isometry3d::Identity());
  /// The same when `half_grey`, the mean of each 2x2 pixels, is there already. Requires
  /// takesHalfGrey().
  void assignHalf(ImageView<float> half_grey, ImageView<float> depth,
                  const Eigen::Isometry3d& T_color_depth = Eigen::Isometry3d::Identity());
  /// The images are larger than the finest level.
  [[nodiscard]] bool takesHalfGrey() const { return first_halvings_ > 0; }

  /// Finest first.
  [[nodiscard]] const std::vector<RgbdLevel>& levels() const { return levels_; }

 private:
  void assignFullSize(ImageView<std::uint8_t> grey, ImageView<float> depth,
                      const Eigen::Isometry3d& T_color_depth);
  void halveOn();

  DepthRange depth_range_;
  int first_halvings_;
  std::vector<RgbdLevel> finer_;  ///< levels above the finest tracked one, only steps to it
  std::vector<RgbdLevel> levels_;
  Image<float> half_grey_;  ///< keeps its memory
};

}  // namespace planecloud

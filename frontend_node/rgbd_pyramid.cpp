// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/frontend_node/rgbd_pyramid.h"

#include <stdexcept>

#include "planecloud_slam/frontend_node/grey_motion.h"

namespace planecloud {
namespace {

RgbdLevel makeLevel(const CameraIntrinsics& camera, int halvings) {
  RgbdLevel level;
  level.camera = levelCamera(camera, halvings);
  level.pixels.resize(level.camera.width, level.camera.height);
  return level;
}

void halve(const RgbdLevel& fine, RgbdLevel& coarse) {
  for (int y = 0; y < coarse.camera.height; ++y) {
    vectorPyramidKernels().halve_level(fine.pixels.row(2 * y), fine.pixels.row(2 * y + 1),
                                       coarse.camera.width, coarse.pixels.row(y));
  }
}

bool isMotion(const Eigen::Isometry3d& T) { return !T.matrix().isIdentity(0.0); }

}  // namespace

LevelCamera levelCamera(const CameraIntrinsics& camera, int halvings) {
  const double scale = 1.0 / static_cast<double>(1 << halvings);
  LevelCamera level;
  level.width = camera.width >> halvings;
  level.height = camera.height >> halvings;
  level.fx = static_cast<float>(camera.fx * scale);
  level.fy = static_cast<float>(camera.fy * scale);
  level.cx = static_cast<float>((camera.cx + 0.5) * scale - 0.5);
  level.cy = static_cast<float>((camera.cy + 0.5) * scale - 0.5);
  return level;
}

RgbdPyramid::RgbdPyramid(const CameraIntrinsics& camera, const DenseTrackerOptions& options)
    : depth_range_{static_cast<float>(options.min_depth), static_cast<float>(options.max_depth)},
      first_halvings_(0) {
  options.check();
  camera.check();
  if (camera.hasDistortion()) {
    throw std::invalid_argument("tracking needs a camera without distortion: rectify the images");
  }
  while ((camera.width >> first_halvings_) > options.finest_width) ++first_halvings_;
  const int last = first_halvings_ + options.levels - 1;
  if ((camera.width >> last) < 16 || (camera.height >> last) < 12) {
    throw std::invalid_argument("tracking/levels = " + std::to_string(options.levels) +
                                ": the coarsest level would be smaller than 16 x 12 pixels, "
                                "use fewer levels or a larger tracking/finest_width");
  }
  for (int halvings = 1; halvings < first_halvings_; ++halvings) {
    finer_.push_back(makeLevel(camera, halvings));
  }
  for (int halvings = first_halvings_; halvings <= last; ++halvings) {
    levels_.push_back(makeLevel(camera, halvings));
  }
}

void RgbdPyramid::assign(ImageView<std::uint8_t> grey, ImageView<float> depth,
                         const Eigen::Isometry3d& T_color_depth) {
  if (!takesHalfGrey()) {
    return assignFullSize(grey, depth, T_color_depth);
  }
  half_grey_.resize(grey.width() / 2, grey.height() / 2);
  for (int y = 0; y < half_grey_.height(); ++y) {
    vectorPyramidKernels().halve_grey({grey.row(2 * y), grey.row(2 * y + 1)}, half_grey_.width(),
                                      half_grey_.row(y));
  }
  assignHalf(half_grey_.view(), depth, T_color_depth);
}

void RgbdPyramid::assignHalf(ImageView<float> half_grey, ImageView<float> depth,
                             const Eigen::Isometry3d& T_color_depth) {
  RgbdLevel& first = finer_.empty() ? levels_.front() : finer_.front();
  for (int y = 0; y < first.camera.height; ++y) {
    vectorPyramidKernels().halve_depth({depth.row(2 * y), depth.row(2 * y + 1), half_grey.row(y)},
                                       depth_range_, first.camera.width, first.pixels.row(y));
  }
  if (isMotion(T_color_depth)) moveGrey(T_color_depth, half_grey, first);
  halveOn();
}

void RgbdPyramid::assignFullSize(ImageView<std::uint8_t> grey, ImageView<float> depth,
                                 const Eigen::Isometry3d& T_color_depth) {
  Image<GreyDepth>& pixels = levels_.front().pixels;
  for (int y = 0; y < pixels.height(); ++y) {
    for (int x = 0; x < pixels.width(); ++x) {
      const float z = depth(x, y);
      const bool is_usable = z >= depth_range_.least && z <= depth_range_.most;
      pixels(x, y) = {static_cast<float>(grey(x, y)), is_usable ? 1.0F / z : 0.0F};
    }
  }
  if (isMotion(T_color_depth)) {
    moveGrey(T_color_depth, greyOf(levels_.front()).view(), levels_.front());
  }
  halveOn();
}

/// Makes all levels of the first one.
void RgbdPyramid::halveOn() {
  for (std::size_t i = 1; i < finer_.size(); ++i) halve(finer_[i - 1], finer_[i]);
  if (!finer_.empty()) halve(finer_.back(), levels_.front());
  for (std::size_t i = 1; i < levels_.size(); ++i) halve(levels_[i - 1], levels_[i]);
}

}  // namespace planecloud

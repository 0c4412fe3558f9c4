// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/frontend_node/live_images.h"

namespace planecloud {

LiveImages::LiveImages(const CameraIntrinsics& camera, const DenseTrackerOptions& options)
    : pyramids_{RgbdPyramid(camera.rectified(), options),
                RgbdPyramid(camera.rectified(), options)} {
  if (camera.hasDistortion()) rectifier_.emplace(camera);
}

void LiveImages::assign(const RgbdFrame& frame, const Eigen::Isometry3d& T_color_depth) {
  current_ = 1 - kept_;
  RgbdPyramid& pyramid = pyramids_[current_];
  if (!rectifier_) return pyramid.assign(frame.grey.view(), frame.depth.view(), T_color_depth);
  rectifier_->rectifyDepth(frame.depth, rectified_.depth);
  if (pyramid.takesHalfGrey()) {
    rectifier_->rectifyHalfGrey(frame.grey, half_grey_);
    return pyramid.assignHalf(half_grey_.view(), rectified_.depth.view(), T_color_depth);
  }
  rectifier_->rectifyColors(frame, rectified_);
  pyramid.assign(rectified_.grey.view(), rectified_.depth.view(), T_color_depth);
}

ImageView<float> LiveImages::depth(const RgbdFrame& frame) const {
  return rectifier_ ? rectified_.depth.view() : frame.depth.view();
}

RgbdFrame LiveImages::full(const RgbdFrame& frame) const {
  if (!rectifier_) return frame;
  RgbdFrame rectified{frame.stamp, {}, rectified_.depth, {}};
  rectifier_->rectifyColors(frame, rectified);
  return rectified;
}

}  // namespace planecloud

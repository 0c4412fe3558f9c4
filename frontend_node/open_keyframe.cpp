// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/frontend_node/open_keyframe.h"

#include <utility>

namespace planecloud {

OpenKeyframe::OpenKeyframe(const LocalMapOptions& options, const CameraIntrinsics& camera)
    : camera_(camera), local_map_(options, camera) {}

void OpenKeyframe::open(RgbdFrame frame, TrackedReference reference,
                        std::vector<RelativePoseEdge> edges) {
  reference_ = std::move(reference);
  keyframe_ = Keyframe{};
  keyframe_.id = reference_.view->id;
  keyframe_.stamp = frame.stamp;
  keyframe_.T_odom_camera = reference_.view->T_odom_camera;
  keyframe_.edges = std::move(edges);
  grey_ = std::move(frame.grey);
  color_ = std::move(frame.color);
  local_map_.open(frame.depth.view());
  is_open_ = true;
}

void OpenKeyframe::fuse(ImageView<float> depth, const Eigen::Isometry3d& T_keyframe_camera) {
  if (is_open_) local_map_.fuse(depth, T_keyframe_camera);
}

CompletedKeyframe OpenKeyframe::complete(std::vector<KeyframeViewPtr> earlier) {
  is_open_ = false;
  CompletedKeyframe completed;
  completed.keyframe = std::move(keyframe_);
  completed.depth = local_map_.depth();
  completed.grey = std::move(grey_);
  completed.camera = camera_;
  completed.color = std::move(color_);
  completed.history = {reference_.view, std::move(reference_.points), std::move(earlier)};
  return completed;
}

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/frontend_node/local_map.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <vector>

namespace planecloud {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

bool isDepth(float z) { return z > 0.0F && z < std::numeric_limits<float>::infinity(); }

/// Holes are filled in one row of so many for each frame fused: most stay filled.
constexpr int kFillRows = 4;

}  // namespace

LocalMap::LocalMap(const LocalMapOptions& options, const CameraIntrinsics& camera)
    : options_(options), camera_(camera), inverse_depth_(0, 0), observations_(0, 0) {
  options_.check();
  camera_.check();
  if (camera_.hasDistortion()) {
    throw std::invalid_argument("the local map needs a camera without distortion");
  }
  inverse_depth_ = Image<float>(camera.width, camera.height, 0.0F);
  observations_ = Image<std::uint8_t>(camera.width, camera.height, 0);
  tangents_.resize(static_cast<std::size_t>(camera.width));
  for (std::size_t i = 0; i < tangents_.size(); ++i) {
    tangents_[i] = static_cast<float>((static_cast<double>(i) - camera.cx) / camera.fx);
  }
  pixels_.resize(tangents_.size());
  seen_.resize(tangents_.size());
}

void LocalMap::open(ImageView<float> depth) {
  frames_ = 0;
  for (int y = 0; y < camera_.height; ++y) {
    for (int x = 0; x < camera_.width; ++x) {
      const float z = depth(x, y);
      inverse_depth_(x, y) = isDepth(z) ? 1.0F / z : 0.0F;
      observations_(x, y) = isDepth(z) ? 1 : 0;
    }
  }
}

void LocalMap::fuse(ImageView<float> depth, const Eigen::Isometry3d& T_keyframe_camera) {
  if (!options_.fuse || ++frames_ % options_.interval != 0) return;
  improvePixels(depth, T_keyframe_camera.inverse());
  fillHoles(depth, T_keyframe_camera);
}

FusionWarp LocalMap::warp(const Eigen::Isometry3d& T) const {
  return {T.linear().cast<float>(), T.translation().cast<float>(), camera_,
          static_cast<float>(options_.gate * options_.sigma),
          static_cast<std::uint8_t>(options_.max_observations)};
}

FusionRow LocalMap::row(int y) const {
  return {tangents_.data(), static_cast<float>((y - camera_.cy) / camera_.fy), camera_.width};
}

void LocalMap::improvePixels(ImageView<float> depth, const Eigen::Isometry3d& T_camera_keyframe) {
  const FusionWarp motion = warp(T_camera_keyframe);
  for (int y = 0; y < camera_.height; ++y) {
    vectorFusionKernels().improve(motion, row(y), depth, inverse_depth_.row(y),
                                  observations_.row(y));
  }
}

void LocalMap::fillHoles(ImageView<float> depth, const Eigen::Isometry3d& T_keyframe_camera) {
  const FusionWarp motion = warp(T_keyframe_camera);
  for (int y = frames_ / options_.interval % kFillRows; y < camera_.height; y += kFillRows) {
    vectorFusionKernels().project(motion, row(y), depth.row(y), pixels_.data(), seen_.data());
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
      if (pixels_[i] < 0 || observations_.begin()[pixels_[i]] > 0) continue;
      inverse_depth_.begin()[pixels_[i]] = seen_[i];
      observations_.begin()[pixels_[i]] = 1;
    }
  }
}

Image<float> LocalMap::depth() const {
  Image<float> depth(camera_.width, camera_.height);
  for (int y = 0; y < camera_.height; ++y) {
    for (int x = 0; x < camera_.width; ++x) {
      const float q = inverse_depth_(x, y);
      depth(x, y) = q > 0.0F ? 1.0F / q : kNone;
    }
  }
  return depth;
}

}  // namespace planecloud

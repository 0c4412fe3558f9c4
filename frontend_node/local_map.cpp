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

constexpr Eigen::Index kLanes = 8;
using Lanes = Eigen::Array<float, kLanes, 1>;

bool isDepth(float z) { return z > 0.0F && z < std::numeric_limits<float>::infinity(); }

/// Depth [m] at a real pixel: linear where the four pixels around lie within `tolerance` [m] of
/// each other, else 0.
float sample(ImageView<float> depth, float x, float y, float tolerance) {
  const int column = static_cast<int>(x);
  const int row = static_cast<int>(y);
  const float fx = x - static_cast<float>(column);
  const float fy = y - static_cast<float>(row);
  const float* upper = depth.row(row) + column;
  const float* lower = upper + depth.stride();
  const float a = upper[0];
  const float b = upper[1];
  const float c = lower[0];
  const float d = lower[1];
  if (!(a > 0.0F && b > 0.0F && c > 0.0F && d > 0.0F)) return 0.0F;
  const float low = std::min(std::min(a, b), std::min(c, d));
  const float high = std::max(std::max(a, b), std::max(c, d));
  if (!(high - low < tolerance)) return 0.0F;
  const float top = a + fx * (b - a);
  const float bottom = c + fx * (d - c);
  return top + fy * (bottom - top);
}

}  // namespace

/// Where the pixels of one row are seen from another pose. Rows are padded to whole lanes.
struct LocalMap::RowWarp {
  Eigen::Matrix3f R = Eigen::Matrix3f::Identity();
  Eigen::Vector3f t = Eigen::Vector3f::Zero();
  float fx, fy, cx, cy, right, bottom;
  std::vector<float> u;             ///< tangents of the columns
  std::vector<float> q;             ///< inverse depths of the row [1/m], 0: none
  std::vector<float> x, y, seen_q;  ///< pixel and inverse depth they are seen at

  explicit RowWarp(const CameraIntrinsics& camera)
      : fx(static_cast<float>(camera.fx)),
        fy(static_cast<float>(camera.fy)),
        cx(static_cast<float>(camera.cx)),
        cy(static_cast<float>(camera.cy)),
        right(static_cast<float>(camera.width - 1)),
        bottom(static_cast<float>(camera.height - 1)) {
    const auto lanes = static_cast<std::size_t>(kLanes);
    const std::size_t padded = (static_cast<std::size_t>(camera.width) + lanes - 1) / lanes * lanes;
    for (std::vector<float>* array : {&u, &q, &x, &y, &seen_q}) array->assign(padded, 0.0F);
    for (std::size_t i = 0; i < padded; ++i) u[i] = (static_cast<float>(i) - cx) / fx;
  }

  void setMotion(const Eigen::Isometry3d& T) {
    R = T.linear().cast<float>();
    t = T.translation().cast<float>();
  }

  /// Fills x, y and seen_q from row `row` of inverse depths `q`.
  void run(int row) {
    const float v = (static_cast<float>(row) - cy) / fy;
    const Eigen::Vector3f base = R.col(1) * v + R.col(2);
    for (std::size_t i = 0; i < u.size(); i += static_cast<std::size_t>(kLanes)) {
      const Lanes tangent = Eigen::Map<const Lanes>(u.data() + i);
      const Lanes inverse_depth = Eigen::Map<const Lanes>(q.data() + i);
      const Lanes inverse_z = 1.0F / (R(2, 0) * tangent + (base.z() + t.z() * inverse_depth));
      Eigen::Map<Lanes>(x.data() + i) =
          fx * (R(0, 0) * tangent + (base.x() + t.x() * inverse_depth)) * inverse_z + cx;
      Eigen::Map<Lanes>(y.data() + i) =
          fy * (R(1, 0) * tangent + (base.y() + t.y() * inverse_depth)) * inverse_z + cy;
      Eigen::Map<Lanes>(seen_q.data() + i) = inverse_depth * inverse_z;
    }
  }

  [[nodiscard]] bool isSeen(std::size_t i) const {
    return seen_q[i] > 0.0F && x[i] >= 0.0F && x[i] < right && y[i] >= 0.0F && y[i] < bottom;
  }
};

LocalMap::LocalMap(const LocalMapOptions& options, const CameraIntrinsics& camera)
    : options_(options), camera_(camera), inverse_depth_(0, 0), observations_(0, 0) {
  options_.check();
  camera_.check();
  if (camera_.hasDistortion()) {
    throw std::invalid_argument("the local map needs a camera without distortion");
  }
  inverse_depth_ = Image<float>(camera.width, camera.height, 0.0F);
  observations_ = Image<float>(camera.width, camera.height, 0.0F);
  warp_ = std::make_unique<RowWarp>(camera_);
}

LocalMap::~LocalMap() = default;
LocalMap::LocalMap(LocalMap&&) noexcept = default;
LocalMap& LocalMap::operator=(LocalMap&&) noexcept = default;

void LocalMap::open(ImageView<float> depth) {
  frames_ = 0;
  for (int y = 0; y < camera_.height; ++y) {
    for (int x = 0; x < camera_.width; ++x) {
      const float z = depth(x, y);
      inverse_depth_(x, y) = isDepth(z) ? 1.0F / z : 0.0F;
      observations_(x, y) = isDepth(z) ? 1.0F : 0.0F;
    }
  }
}

void LocalMap::fuse(ImageView<float> depth, const Eigen::Isometry3d& T_keyframe_camera) {
  if (!options_.fuse || ++frames_ % options_.interval != 0) return;
  improvePixels(depth, T_keyframe_camera.inverse());
  fillHoles(depth, T_keyframe_camera);
}

void LocalMap::improvePixels(ImageView<float> depth, const Eigen::Isometry3d& T_camera_keyframe) {
  const auto gate = static_cast<float>(options_.gate * options_.sigma);
  const auto most = static_cast<float>(options_.max_observations);
  warp_->setMotion(T_camera_keyframe);
  for (int row = 0; row < camera_.height; ++row) {
    float* mean = inverse_depth_.row(row);
    float* observations = observations_.row(row);
    std::copy(mean, mean + camera_.width, warp_->q.begin());
    warp_->run(row);
    for (std::size_t i = 0; i < static_cast<std::size_t>(camera_.width); ++i) {
      if (!warp_->isSeen(i)) continue;
      const float predicted = 1.0F / warp_->seen_q[i];
      const float tolerance = 2.0F * gate * predicted * predicted;
      const float z = sample(depth, warp_->x[i], warp_->y[i], tolerance);
      if (z == 0.0F) continue;
      // A depth error is the same length in both views, an inverse depth error is not.
      const float deviation = (predicted - z) * mean[i] * mean[i];
      const float n = observations[i];
      if (deviation * deviation * n > gate * gate * (n + 1.0F)) continue;
      mean[i] += deviation / (n + 1.0F);
      observations[i] = std::min(n + 1.0F, most);
    }
  }
}

void LocalMap::fillHoles(ImageView<float> depth, const Eigen::Isometry3d& T_keyframe_camera) {
  warp_->setMotion(T_keyframe_camera);
  for (int row = 0; row < camera_.height; ++row) {
    const float* z = depth.row(row);
    for (std::size_t i = 0; i < static_cast<std::size_t>(camera_.width); ++i) {
      warp_->q[i] = isDepth(z[i]) ? 1.0F / z[i] : 0.0F;
    }
    warp_->run(row);
    for (std::size_t i = 0; i < static_cast<std::size_t>(camera_.width); ++i) {
      if (!warp_->isSeen(i)) continue;
      const int x = static_cast<int>(warp_->x[i] + 0.5F);
      const int y = static_cast<int>(warp_->y[i] + 0.5F);
      if (observations_(x, y) > 0.0F) continue;
      inverse_depth_(x, y) = warp_->seen_q[i];
      observations_(x, y) = 1.0F;
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

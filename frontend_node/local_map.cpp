// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/frontend_node/local_map.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace planecloud_slam {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

/// A motion between two pinhole images in float, applied to (u, v, 1) / q.
struct Warp {
  Eigen::Matrix3f R;
  Eigen::Vector3f t;
  float fx, fy, cx, cy;

  Warp(const CameraIntrinsics& camera, const Eigen::Isometry3d& T)
      : R(T.linear().cast<float>()),
        t(T.translation().cast<float>()),
        fx(static_cast<float>(camera.fx)),
        fy(static_cast<float>(camera.fy)),
        cx(static_cast<float>(camera.cx)),
        cy(static_cast<float>(camera.cy)) {}

  /// Pixel and inverse depth of the point that (x, y) sees at inverse depth q.
  [[nodiscard]] Eigen::Vector3f operator()(int x, int y, float q) const {
    const float u = (static_cast<float>(x) - cx) / fx;
    const float v = (static_cast<float>(y) - cy) / fy;
    const Eigen::Vector3f p = R * Eigen::Vector3f(u, v, 1.0F) + q * t;
    const float inverse_z = 1.0F / p.z();
    return {fx * p.x() * inverse_z + cx, fy * p.y() * inverse_z + cy, q * inverse_z};
  }
};

/// Inverse depth at a real pixel of `depth`: linear where the four pixels around lie within
/// `tolerance` [1/m] of each other, else 0.
float sample(ImageView<float> depth, float x, float y, float tolerance) {
  const int column = static_cast<int>(x);
  const int row = static_cast<int>(y);
  const float fx = x - static_cast<float>(column);
  const float fy = y - static_cast<float>(row);
  const float* upper = depth.row(row) + column;
  const float* lower = depth.row(row + 1) + column;
  const float a = 1.0F / upper[0];
  const float b = 1.0F / upper[1];
  const float c = 1.0F / lower[0];
  const float d = 1.0F / lower[1];
  const float low = std::min(std::min(a, b), std::min(c, d));
  const float high = std::max(std::max(a, b), std::max(c, d));
  // Written so that NaN fails.
  if (!(low > 0.0F && high - low < tolerance && a + b + c + d < 1e6F)) return 0.0F;
  const float top = a + fx * (b - a);
  const float bottom = c + fx * (d - c);
  return top + fy * (bottom - top);
}

bool isInside(const Eigen::Vector3f& pixel, int width, int height) {
  return pixel.x() >= 0.0F && pixel.x() < static_cast<float>(width - 1) && pixel.y() >= 0.0F &&
         pixel.y() < static_cast<float>(height - 1) && pixel.z() > 0.0F;
}

}  // namespace

LocalMap::LocalMap(const LocalMapOptions& options, const CameraIntrinsics& camera)
    : options_(options),
      camera_(camera),
      inverse_depth_(camera.width, camera.height, 0.0F),
      observations_(camera.width, camera.height, 0.0F) {
  options_.check();
  camera_.check();
  if (camera_.hasDistortion()) {
    throw std::invalid_argument("the local map needs a camera without distortion");
  }
}

void LocalMap::open(ImageView<float> depth) {
  for (int y = 0; y < camera_.height; ++y) {
    for (int x = 0; x < camera_.width; ++x) {
      const float z = depth(x, y);
      const bool valid = std::isfinite(z) && z > 0.0F;
      inverse_depth_(x, y) = valid ? 1.0F / z : 0.0F;
      observations_(x, y) = valid ? 1.0F : 0.0F;
    }
  }
}

void LocalMap::fuse(ImageView<float> depth, const Eigen::Isometry3d& T_keyframe_camera) {
  if (!options_.fuse) return;
  improvePixels(depth, T_keyframe_camera.inverse());
  fillHoles(depth, T_keyframe_camera);
}

void LocalMap::improvePixels(ImageView<float> depth, const Eigen::Isometry3d& T_camera_keyframe) {
  const Warp warp(camera_, T_camera_keyframe);
  const auto sigma = static_cast<float>(options_.sigma);
  const auto gate = static_cast<float>(options_.gate);
  const auto most = static_cast<float>(options_.max_observations);
  for (int y = 0; y < camera_.height; ++y) {
    for (int x = 0; x < camera_.width; ++x) {
      float& mean = inverse_depth_(x, y);
      float& n = observations_(x, y);
      if (!(n > 0.0F)) continue;
      const Eigen::Vector3f seen = warp(x, y, mean);
      if (!isInside(seen, camera_.width, camera_.height)) continue;
      const float q = sample(depth, seen.x(), seen.y(), 2.0F * gate * sigma);
      if (q == 0.0F) continue;
      // A depth error is the same length in both views, an inverse depth error is not.
      const float ratio = mean / seen.z();
      const float deviation = (q - seen.z()) * ratio * ratio;
      if (std::abs(deviation) > gate * sigma * std::sqrt(1.0F + 1.0F / n)) continue;
      mean += deviation / (n + 1.0F);
      n = std::min(n + 1.0F, most);
    }
  }
}

void LocalMap::fillHoles(ImageView<float> depth, const Eigen::Isometry3d& T_keyframe_camera) {
  const Warp warp(camera_, T_keyframe_camera);
  for (int y = 0; y < camera_.height; ++y) {
    for (int x = 0; x < camera_.width; ++x) {
      const float z = depth(x, y);
      if (!(std::isfinite(z) && z > 0.0F)) continue;
      const Eigen::Vector3f seen = warp(x, y, 1.0F / z);
      if (!isInside(seen, camera_.width, camera_.height)) continue;
      const int column = static_cast<int>(seen.x() + 0.5F);
      const int row = static_cast<int>(seen.y() + 0.5F);
      if (observations_(column, row) > 0.0F) continue;
      inverse_depth_(column, row) = seen.z();
      observations_(column, row) = 1.0F;
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

}  // namespace planecloud_slam

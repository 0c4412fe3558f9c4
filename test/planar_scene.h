// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

#include "planecloud_slam/plane_fit/camera.h"

/// Small depth images with known planes for the unit tests of plane_fit.
namespace planecloud {

inline CameraIntrinsics testCamera(int width = 640, int height = 480) {
  return {width, height, 525.0, 520.0, 0.5 * width - 1.3, 0.5 * height + 0.7, {}};
}

inline CameraIntrinsics distortedTestCamera() {
  return {640, 480, 517.3, 516.5, 318.6, 255.3, {0.2624, -0.9531, -0.0054, 0.0026, 1.1633}};
}

/// Depth [m] of the plane q = alpha u + beta v + gamma, NaN where it is not in front.
inline Image<float> renderPlane(const Camera& camera, const Eigen::Vector3f& inverse_depth) {
  Image<float> depth(camera.width(), camera.height());
  for (int y = 0; y < camera.height(); ++y) {
    for (int x = 0; x < camera.width(); ++x) {
      const Eigen::Vector3f ray(camera.tangentsX()(x, y), camera.tangentsY()(x, y), 1.0F);
      const float q = inverse_depth.dot(ray);
      depth(x, y) = q > 0.05F ? 1.0F / q : std::numeric_limits<float>::quiet_NaN();
    }
  }
  return depth;
}

/// A corridor: floor, two walls and an end wall 4 m ahead, with a box in it.
inline Image<float> renderCorridor(const Camera& camera) {
  Image<float> depth(camera.width(), camera.height());
  for (int y = 0; y < camera.height(); ++y) {
    for (int x = 0; x < camera.width(); ++x) {
      const float u = camera.tangentsX()(x, y);
      const float v = camera.tangentsY()(x, y);
      float q = std::max({0.25F, v / 0.8F, -u / 1.1F, u / 1.3F});
      if (u > 0.05F && u < 0.25F && v > -0.05F && v < 0.2F) q = 0.6F + 0.3F * u;
      depth(x, y) = 1.0F / q;
    }
  }
  return depth;
}

/// Rounds to 1/8 px of disparity (570 px, 75 mm) after noise of `noise` steps, and makes holes:
/// single pixels and blobs.
inline void addSensorNoise(Image<float>& depth, double noise, std::uint32_t seed) {
  constexpr float kStep = 2.9e-3F;  // [1/m]
  std::mt19937 random(seed);
  std::normal_distribution<float> gauss(0.0F, static_cast<float>(noise));
  std::uniform_real_distribution<float> uniform(0.0F, 1.0F);
  for (float& z : depth) {
    z = 1.0F / (kStep * std::max(1.0F, std::round(1.0F / (z * kStep) + gauss(random))));
    if (uniform(random) < 0.005F) z = std::numeric_limits<float>::quiet_NaN();
  }
  for (int blob = 0; blob < 20; ++blob) {
    const int x0 = static_cast<int>(uniform(random) * static_cast<float>(depth.width() - 20));
    const int y0 = static_cast<int>(uniform(random) * static_cast<float>(depth.height() - 20));
    for (int y = y0; y < y0 + 20; ++y) {
      for (int x = x0; x < x0 + 20; ++x) depth(x, y) = std::numeric_limits<float>::quiet_NaN();
    }
  }
}

/// 16UC1 millimetres, 0: none.
inline Image<std::uint16_t> toMillimetres(const Image<float>& depth) {
  Image<std::uint16_t> result(depth.width(), depth.height());
  for (int y = 0; y < depth.height(); ++y) {
    for (int x = 0; x < depth.width(); ++x) {
      const float z = depth(x, y);
      result(x, y) = z > 0.0F ? static_cast<std::uint16_t>(std::lround(1000.0F * z)) : 0;
    }
  }
  return result;
}

}  // namespace planecloud

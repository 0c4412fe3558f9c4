// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

#include "planecloud_slam/frontend_node/frontend.h"
#include "planecloud_slam/plane_fit/camera.h"
#include "planecloud_slam/plane_fit/image_view.h"

/// A textured box room with a pillar, ray-cast with exact poses: small and quick enough for tests.
namespace planecloud::synthetic {

/// 320 x 240 pixels, 58 degrees wide.
inline CameraIntrinsics camera() {
  CameraIntrinsics camera;
  camera.width = 320;
  camera.height = 240;
  camera.fx = camera.fy = 285.0;
  camera.cx = 159.5;
  camera.cy = 119.5;
  return camera;
}

struct SceneOptions {
  double grey_noise = 0.0;   ///< standard deviation [grey levels]
  double depth_noise = 0.0;  ///< standard deviation of inverse depth [1/m]
  double gain = 1.0;         ///< exposure
  double offset = 0.0;       ///< exposure [grey levels]
  unsigned seed = 1;
};

/// Smooth texture of a point of the world [m], 40..215.
inline double texture(const Eigen::Vector3d& p) {
  const double a = std::sin(9.0 * p.x() + 2.0 * std::sin(4.0 * p.y())) * std::cos(7.0 * p.z());
  const double b = std::sin(17.0 * p.y() + 3.0 * p.x()) * std::sin(13.0 * p.z() + 1.0);
  return 128.0 + 55.0 * a + 32.0 * b;
}

/// Distance along `ray` from `origin` to the room (x, y in [-2, 2], z in [-1.5, 3]; a pillar at
/// x = 0.4, z = 1.6 of 0.3 m side), all in the world [m].
inline double castRay(const Eigen::Vector3d& origin, const Eigen::Vector3d& ray) {
  const Eigen::Vector3d low(-2.0, -2.0, -1.5);
  const Eigen::Vector3d high(2.0, 2.0, 3.0);
  double distance = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(ray(axis)) < 1e-12) continue;
    const double wall = ray(axis) > 0.0 ? high(axis) : low(axis);
    distance = std::min(distance, (wall - origin(axis)) / ray(axis));
  }
  double enter = 0.0;
  double leave = distance;
  for (const int axis : {0, 2}) {
    const double centre = axis == 0 ? 0.4 : 1.6;
    double near = (centre - 0.15 - origin(axis)) / ray(axis);
    double far = (centre + 0.15 - origin(axis)) / ray(axis);
    if (near > far) std::swap(near, far);
    enter = std::max(enter, near);
    leave = std::min(leave, far);
  }
  return enter < leave && enter > 0.0 ? enter : distance;
}

/// What the camera at `T_world_camera` sees; the identity looks along z at the back wall.
inline RgbdFrame render(const CameraIntrinsics& camera, const Eigen::Isometry3d& T_world_camera,
                        const SceneOptions& options = {}) {
  std::mt19937 random(options.seed);
  std::normal_distribution<double> normal;
  RgbdFrame frame{0.0, Image<std::uint8_t>(camera.width, camera.height),
                  Image<float>(camera.width, camera.height)};
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const Eigen::Vector3d ray_camera((x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy,
                                       1.0);
      const Eigen::Vector3d ray = T_world_camera.linear() * ray_camera;
      const double z = castRay(T_world_camera.translation(), ray);
      const Eigen::Vector3d point = T_world_camera.translation() + z * ray;
      const double grey =
          options.gain * texture(point) + options.offset + options.grey_noise * normal(random);
      frame.grey(x, y) =
          static_cast<std::uint8_t>(std::lround(std::min(std::max(grey, 0.0), 255.0)));
      frame.depth(x, y) =
          static_cast<float>(1.0 / (1.0 / z + options.depth_noise * normal(random)));
    }
  }
  return frame;
}

/// A pose from translation [m] and rotation vector [rad].
inline Eigen::Isometry3d pose(double x, double y, double z, double rx = 0.0, double ry = 0.0,
                              double rz = 0.0) {
  const Eigen::Vector3d phi(rx, ry, rz);
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() = Eigen::Vector3d(x, y, z);
  if (phi.norm() > 0.0) T.linear() = Eigen::AngleAxisd(phi.norm(), phi.normalized()).matrix();
  return T;
}

}  // namespace planecloud::synthetic

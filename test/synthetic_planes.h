// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "planecloud_slam/plane_fit/camera.h"
#include "planecloud_slam/plane_fit/plane_cloud.h"
#include "planecloud_slam/plane_fit/se3.h"

namespace planecloud {

/// A rectangle in the world, seen from both sides.
struct Face {
  Eigen::Vector3d centre;  ///< [m]
  Eigen::Vector3d half_a;  ///< from the centre to the middle of one side [m]
  Eigen::Vector3d half_b;  ///< likewise, at right angles to half_a [m]
};

/// A world of rectangles, and the plane clouds a noisy depth camera would make of it.
class SyntheticPlanes {
 public:
  explicit SyntheticPlanes(std::vector<Face> faces) : faces_(std::move(faces)) {}

  [[nodiscard]] const std::vector<Face>& faces() const { return faces_; }

  /// The six faces of a box, its edges along the axes.
  void addBox(const Eigen::Vector3d& centre, const Eigen::Vector3d& half) {
    for (int axis = 0; axis < 3; ++axis) {
      const int a = (axis + 1) % 3;
      const int b = (axis + 2) % 3;
      for (const double side : {-1.0, 1.0}) {
        Face face{centre, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
        face.centre[axis] += side * half[axis];
        face.half_a[a] = half[a];
        face.half_b[b] = half[b];
        faces_.push_back(face);
      }
    }
  }

  /// What a camera at `T_world_camera` makes of the world: tiles of 32 px, cut down to 8 px where
  /// surfaces meet. `inverse_depth_noise` [1/m] is that of one pixel, independent every 5 px.
  [[nodiscard]] PlaneCloud view(const Eigen::Isometry3d& T_world_camera, double inverse_depth_noise,
                                unsigned seed) const {
    PlaneCloud cloud;
    cloud.camera = camera();
    cloud.layout = {32, 32, 8};
    std::mt19937 random(seed);
    const Sight sight{cloud.camera, T_world_camera, inverse_depth_noise};
    for (int y = 0; y < 480; y += 32) {
      for (int x = 0; x < 640; x += 32) addTiles(sight, {x, y, 32, 32}, random, cloud.tiles);
    }
    return cloud;
  }

  /// The camera of `view`.
  [[nodiscard]] static CameraIntrinsics camera() {
    CameraIntrinsics camera;
    camera.width = 640;
    camera.height = 480;
    camera.fx = 525.0;
    camera.fy = 525.0;
    camera.cx = 319.5;
    camera.cy = 239.5;
    return camera;
  }

  /// What the ray of a pixel of `camera` meets first.
  struct Hit {
    int face = -1;                                      ///< index into `faces`, -1: nothing
    double depth = std::numeric_limits<double>::max();  ///< along the optical axis [m]
    Eigen::Vector3d point = Eigen::Vector3d::Zero();    ///< in the world [m]
  };
  [[nodiscard]] Hit firstHit(const Eigen::Isometry3d& T_world_camera, double x, double y) const {
    const CameraIntrinsics k = camera();
    const Eigen::Vector3d origin = T_world_camera.translation();
    const Eigen::Vector3d ray =
        T_world_camera.linear() * Eigen::Vector3d((x - k.cx) / k.fx, (y - k.cy) / k.fy, 1.0);
    Hit nearest;
    for (std::size_t i = 0; i < faces_.size(); ++i) {
      const Face& face = faces_[i];
      const Eigen::Vector3d normal = face.half_a.cross(face.half_b);
      const double depth = normal.dot(face.centre - origin) / normal.dot(ray);
      if (!(depth > 0.3 && depth < nearest.depth)) continue;
      const Eigen::Vector3d point = origin + depth * ray;
      const Eigen::Vector3d offset = point - face.centre;
      if (std::abs(offset.dot(face.half_a)) > face.half_a.squaredNorm()) continue;
      if (std::abs(offset.dot(face.half_b)) > face.half_b.squaredNorm()) continue;
      nearest = {static_cast<int>(i), depth, point};
    }
    return nearest;
  }

 private:
  struct Sight {
    CameraIntrinsics camera;
    Eigen::Isometry3d T_world_camera;
    double noise;
  };

  void addTiles(const Sight& sight, const TileRect& rect, std::mt19937& random,
                std::vector<PlanarTile>& tiles) const {
    const int face = commonFace(sight, rect);
    if (face >= 0) {
      tiles.push_back(makeTile(sight, rect, faces_[static_cast<std::size_t>(face)], random));
    } else if (rect.width > 8) {
      const int w = rect.width / 2;
      const int h = rect.height / 2;
      for (const int y : {rect.y, rect.y + h}) {
        for (const int x : {rect.x, rect.x + w}) addTiles(sight, {x, y, w, h}, random, tiles);
      }
    }
  }

  /// The face that all corners and the centre of the rectangle see, else -1.
  [[nodiscard]] int commonFace(const Sight& sight, const TileRect& rect) const {
    const int face = firstHit(sight.T_world_camera, rect.x, rect.y).face;
    for (const double s : {0.0, 0.5, 1.0}) {
      for (const double t : {0.0, 0.5, 1.0}) {
        const double x = rect.x + s * (rect.width - 1);
        const double y = rect.y + t * (rect.height - 1);
        if (firstHit(sight.T_world_camera, x, y).face != face) return -1;
      }
    }
    return face;
  }

  /// The face's plane plus the error of a regression over the rectangle.
  [[nodiscard]] static PlanarTile makeTile(const Sight& sight, const TileRect& rect,
                                           const Face& face, std::mt19937& random) {
    const CameraIntrinsics& k = sight.camera;
    const Eigen::Isometry3d T_camera_world = sight.T_world_camera.inverse();
    const Eigen::Vector3d normal = T_camera_world.linear() * face.half_a.cross(face.half_b);
    Eigen::Vector3d coefficients = normal / normal.dot(T_camera_world * face.centre);
    std::normal_distribution<double> gauss;
    const double sigma = sight.noise / std::sqrt(std::max(1.0, rect.area() / 25.0));
    const double tilt_x = std::sqrt(12.0) * k.fx / rect.width * sigma * gauss(random);
    const double tilt_y = std::sqrt(12.0) * k.fy / rect.height * sigma * gauss(random);
    const double u = (rect.x + 0.5 * (rect.width - 1) - k.cx) / k.fx;
    const double v = (rect.y + 0.5 * (rect.height - 1) - k.cy) / k.fy;
    coefficients +=
        Eigen::Vector3d(tilt_x, tilt_y, sigma * gauss(random) - tilt_x * u - tilt_y * v);
    return {rect, coefficients.cast<float>()};
  }

  std::vector<Face> faces_;
};

/// A room of 5 m x 4 m x 2.6 m with furniture, z up: every direction is observed from `roomPose`.
inline SyntheticPlanes makeRoom() {
  SyntheticPlanes world({});
  world.addBox({0.0, 0.0, 1.3}, {2.5, 2.0, 1.3});
  world.addBox({1.6, 1.2, 0.4}, {0.4, 0.3, 0.4});
  world.addBox({1.2, -1.1, 0.7}, {0.25, 0.5, 0.7});
  world.addBox({0.6, 0.5, 0.2}, {0.2, 0.3, 0.2});
  world.addBox({2.2, 0.1, 0.9}, {0.3, 0.4, 0.9});
  return world;
}

/// A corridor of 2.4 m x 2.6 m along x; with an end wall it stops 4 m ahead of `corridorPose`.
inline SyntheticPlanes makeCorridor(bool end_wall) {
  SyntheticPlanes world({});
  const double length = end_wall ? 4.0 : 40.0;
  world.addBox({length - 20.0, 0.0, 1.3}, {20.0, 1.2, 1.3});
  return world;
}

/// An optical frame at `position` that looks along world x, turned left by `yaw` [rad] and down by
/// `pitch` [rad].
inline Eigen::Isometry3d lookAlongX(const Eigen::Vector3d& position, double yaw, double pitch) {
  Eigen::Matrix3d R_body_optical;
  R_body_optical << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = (Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
                   Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()))
                      .toRotationMatrix() *
                  R_body_optical;
  pose.translation() = position;
  return pose;
}

/// A motion of the given lengths in random directions [m, rad].
inline Eigen::Isometry3d randomMotion(double distance, double angle, std::mt19937& random) {
  std::normal_distribution<double> gauss;
  Vector6d xi;
  for (Eigen::Index i = 0; i < 6; ++i) xi(i) = gauss(random);
  xi.head<3>() *= distance / xi.head<3>().norm();
  xi.tail<3>() *= angle / xi.tail<3>().norm();
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.linear() = expSo3(xi.tail<3>()).toRotationMatrix();
  motion.translation() = xi.head<3>();
  return motion;
}

}  // namespace planecloud

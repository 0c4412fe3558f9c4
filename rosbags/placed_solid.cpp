// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/rosbags/placed_solid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace planecloud {
namespace {

constexpr float kNear = 0.02F;  // [m], nothing nearer is seen
constexpr float kNever = std::numeric_limits<float>::infinity();

Eigen::Isometry3d poseOf(const Solid& solid) {
  Eigen::Isometry3d T_world_solid = Eigen::Isometry3d::Identity();
  T_world_solid.translate(solid.centre);
  T_world_solid.rotate(Eigen::AngleAxisd(solid.yaw, Eigen::Vector3d::UnitZ()));
  return T_world_solid;
}

std::array<Eigen::Vector3d, 8> cornersOf(const Solid& solid, const Eigen::Isometry3d& T) {
  std::array<Eigen::Vector3d, 8> corners;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d sign((i & 1) != 0 ? 1 : -1, (i & 2) != 0 ? 1 : -1, (i & 4) != 0 ? 1 : -1);
    corners[static_cast<std::size_t>(i)] = T * solid.half.cwiseProduct(sign);
  }
  return corners;
}

}  // namespace

PlacedSolid::PlacedSolid(const Solid& solid, const Eigen::Isometry3d& T_world_camera,
                         const CameraIntrinsics& camera)
    : solid_(&solid),
      half_(solid.half.cast<float>()),
      heading_(Eigen::Vector2d(std::cos(solid.yaw), std::sin(solid.yaw)).cast<float>()),
      place_(solid.centre.head<2>().cast<float>()),
      texture_offset_(static_cast<float>(std::fmod(7.31 * solid.centre.x(), 64.0)),
                      static_cast<float>(std::fmod(5.17 * solid.centre.y(), 64.0))) {
  const Eigen::Isometry3d T_solid_camera = poseOf(solid).inverse() * T_world_camera;
  origin_ = T_solid_camera.translation().cast<float>();
  R_solid_camera_ = T_solid_camera.linear().cast<float>();
  findExtent(T_solid_camera.inverse(), camera);
}

void PlacedSolid::findExtent(const Eigen::Isometry3d& T_camera_solid,
                             const CameraIntrinsics& camera) {
  const std::array<Eigen::Vector3d, 8> corners = cornersOf(*solid_, T_camera_solid);
  Eigen::Array2d low = Eigen::Array2d::Constant(1e9);
  Eigen::Array2d high = -low;
  double nearest = 1e9;
  const auto include = [&](const Eigen::Vector3d& point) {
    const Eigen::Array2d pixel(camera.fx * point.x() / point.z() + camera.cx,
                               camera.fy * point.y() / point.z() + camera.cy);
    low = low.min(pixel);
    high = high.max(pixel);
    nearest = std::min(nearest, point.z());
  };
  const double near = double{kNear};
  for (std::size_t i = 0; i < 8; ++i) {
    if (corners[i].z() > near) include(corners[i]);
    for (const std::size_t bit : {1u, 2u, 4u}) {
      const Eigen::Vector3d& a = corners[i];
      const Eigen::Vector3d& b = corners[i | bit];
      if ((a.z() > near) == (b.z() > near)) continue;
      include(a + (b - a) * ((near - a.z()) / (b.z() - a.z())));
    }
  }
  const Eigen::Array2d size(camera.width, camera.height);
  visible_ = (high > -1.0).all() && (low < size).all();
  if (!visible_) return;
  nearest_ = static_cast<float>(nearest) - 1e-4F;
  first_pixel_ = (low - 1.0).max(0.0).min(size - 1.0).cast<int>();
  last_pixel_ = (high + 2.0).max(0.0).min(size - 1.0).cast<int>();
}

void PlacedSolid::intersect(RayRow& row, int index) const {
  if (solid_->shape == Solid::Shape::kCylinder) {
    for (int i = 0; i < kTileSide; ++i) {
      const float depth = intersectCylinder({row.u[i], row.v});
      if (depth >= row.depth[i]) continue;
      row.depth[i] = depth;
      row.solid[i] = index;
    }
    return;
  }
  const Eigen::Vector3f start = R_solid_camera_.col(1) * row.v + R_solid_camera_.col(2);
  const Eigen::Vector3f step = R_solid_camera_.col(0);
  const Eigen::Vector3f low = -half_ - origin_;
  const Eigen::Vector3f high = half_ - origin_;
  for (int i = 0; i < kTileSide; ++i) {  // plain arithmetic without branches: vectorised
    float enter = kNear;
    float leave = kNever;
    for (int axis = 0; axis < 3; ++axis) {
      const float inverse = 1.0F / (start[axis] + row.u[i] * step[axis]);
      const float a = low[axis] * inverse;
      const float b = high[axis] * inverse;
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    const bool nearer = (enter < leave) & (enter > kNear) & (enter < row.depth[i]);
    row.depth[i] = nearer ? enter : row.depth[i];
    row.solid[i] = nearer ? index : row.solid[i];
  }
}

float PlacedSolid::intersect(const ImageRay& ray) const {
  if (solid_->shape == Solid::Shape::kCylinder) return intersectCylinder(ray);
  const Eigen::Array3f inverse = directionOf(ray).array().inverse();
  const Eigen::Array3f a = (-half_ - origin_).array() * inverse;
  const Eigen::Array3f b = (half_ - origin_).array() * inverse;
  const float enter = a.min(b).maxCoeff();
  const float leave = a.max(b).minCoeff();
  return enter < leave && enter > kNear ? enter : kNever;
}

float PlacedSolid::intersectCylinder(const ImageRay& ray) const {
  const Eigen::Vector3f direction = directionOf(ray);
  const float radius = half_.x();
  float best = kNever;
  const float a = direction.head<2>().squaredNorm();
  const float b = direction.head<2>().dot(origin_.head<2>());
  const float c = origin_.head<2>().squaredNorm() - radius * radius;
  const float root = b * b - a * c;
  if (root > 0.0F) {
    const float mantle = (-b - std::sqrt(root)) / a;
    const float z = origin_.z() + mantle * direction.z();
    if (mantle > kNear && std::abs(z) <= half_.z()) best = mantle;
  }
  const float cap_z = direction.z() < 0.0F ? half_.z() : -half_.z();
  const float cap = (cap_z - origin_.z()) / direction.z();
  if (cap > kNear && cap < best &&
      (origin_.head<2>() + cap * direction.head<2>()).squaredNorm() < radius * radius) {
    best = cap;
  }
  return best;
}

SurfaceHit PlacedSolid::surfaceAt(const ImageRay& ray, float depth) const {
  SurfaceHit hit;
  hit.direction = directionOf(ray);
  hit.depth = depth;
  hit.point = origin_ + depth * hit.direction;
  int axis = 0;
  if (solid_->shape == Solid::Shape::kBox) {
    ((hit.point.cwiseAbs() - half_)).maxCoeff(&axis);
  } else if (std::abs(std::abs(hit.point.z()) - half_.z()) < 1e-4F) {
    axis = 2;
  } else {
    hit.normal = {hit.point.x() / half_.x(), hit.point.y() / half_.x(), 0.0F};
    return hit;
  }
  const bool positive = hit.point[axis] > 0.0F;
  hit.normal = Eigen::Vector3f::Unit(axis) * (positive ? 1.0F : -1.0F);
  hit.face = 2 * axis + (positive ? 1 : 0);
  return hit;
}

}  // namespace planecloud

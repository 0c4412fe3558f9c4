// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include "planecloud_slam/plane_fit/camera.h"
#include "planecloud_slam/rosbags/hallway_world.h"

namespace planecloud {

/// Pixels computed side by side, also the side of a tile.
constexpr int kTileSide = 16;

/// A ray through the image plane at tangents (u, v); its parameter t is the depth [m].
struct ImageRay {
  float u = 0.0F;
  float v = 0.0F;
};

/// A point on a solid's surface seen by a ray, in the solid's own axes.
struct SurfaceHit {
  Eigen::Vector3f point = Eigen::Vector3f::Zero();       ///< [m]
  Eigen::Vector3f direction = Eigen::Vector3f::UnitX();  ///< of the ray, depth 1 per unit
  Eigen::Vector3f normal = Eigen::Vector3f::UnitX();     ///< outwards, unit
  float depth = 0.0F;                                    ///< [m]
  int face = 0;  ///< 2 * axis + (1 on the positive side); 0 on the mantle of a cylinder
};

/// A row of rays with equal v and the nearest hits found for them so far.
struct RayRow {
  float u[kTileSide];
  float v = 0.0F;
  float depth[kTileSide];  ///< [m]
  int solid[kTileSide];    ///< -1: none
};

/// A solid seen from one camera pose: the camera's centre and axes in the solid's own axes, and
/// the part of the image it can cover.
class PlacedSolid {
 public:
  PlacedSolid(const Solid& solid, const Eigen::Isometry3d& T_world_camera,
              const CameraIntrinsics& camera);

  [[nodiscard]] bool visible() const { return visible_; }
  /// No point of the solid is nearer [m].
  [[nodiscard]] float nearest() const { return nearest_; }
  /// Pixels [first, last] that may see it, within the image.
  [[nodiscard]] const Eigen::Array2i& firstPixel() const { return first_pixel_; }
  [[nodiscard]] const Eigen::Array2i& lastPixel() const { return last_pixel_; }
  [[nodiscard]] const Solid& solid() const { return *solid_; }

  /// Enters `index` for the rays that hit this solid nearer than what they hit so far.
  void intersect(RayRow& row, int index) const;
  /// Depth at which a ray enters the solid; infinity when it passes by.
  [[nodiscard]] float intersect(const ImageRay& ray) const;
  /// The hit of a ray known to enter the solid at `depth`.
  [[nodiscard]] SurfaceHit surfaceAt(const ImageRay& ray, float depth) const;
  /// Camera's axes in the solid's axes.
  [[nodiscard]] const Eigen::Matrix3f& cameraAxes() const { return R_solid_camera_; }
  /// Horizontal part of a vector turned from the solid's axes into the world's.
  [[nodiscard]] Eigen::Vector2f toWorld(const Eigen::Vector3f& vector) const {
    return {heading_.x() * vector.x() - heading_.y() * vector.y(),
            heading_.y() * vector.x() + heading_.x() * vector.y()};
  }
  /// Horizontal place of the solid [m].
  [[nodiscard]] const Eigen::Vector2f& place() const { return place_; }
  [[nodiscard]] const Eigen::Vector3f& half() const { return half_; }
  /// Each solid starts elsewhere in its texture [m], so that no two look alike.
  [[nodiscard]] const Eigen::Vector2f& textureOffset() const { return texture_offset_; }

 private:
  void findExtent(const Eigen::Isometry3d& T_camera_solid, const CameraIntrinsics& camera);
  [[nodiscard]] float intersectCylinder(const ImageRay& ray) const;
  [[nodiscard]] Eigen::Vector3f directionOf(const ImageRay& ray) const {
    return R_solid_camera_.col(0) * ray.u + R_solid_camera_.col(1) * ray.v + R_solid_camera_.col(2);
  }

  const Solid* solid_;
  Eigen::Vector3f half_;
  Eigen::Vector2f heading_;  ///< cosine and sine of the yaw
  Eigen::Vector2f place_;
  Eigen::Vector2f texture_offset_;
  Eigen::Vector3f origin_;  ///< camera's centre in the solid's axes [m]
  Eigen::Matrix3f R_solid_camera_;
  bool visible_ = false;
  float nearest_ = 0.0F;
  Eigen::Array2i first_pixel_ = Eigen::Array2i::Zero();
  Eigen::Array2i last_pixel_ = Eigen::Array2i::Zero();
};

}  // namespace planecloud

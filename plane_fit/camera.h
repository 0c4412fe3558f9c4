// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "planecloud_slam/plane_fit/image_view.h"

namespace planecloud {

/// A pinhole camera with Brown-Conrady lens distortion (OpenCV's plumb_bob). x right, y down,
/// z forward (REP 103 optical frame); pixel centres at integer coordinates.
struct CameraIntrinsics {
  int width = 0;                       ///< [px], [16, 8192]
  int height = 0;                      ///< [px], [16, 8192]
  double fx = 0.0;                     ///< focal length [px], > 0
  double fy = 0.0;                     ///< focal length [px], > 0
  double cx = 0.0;                     ///< principal point [px]
  double cy = 0.0;                     ///< principal point [px]
  std::array<double, 5> distortion{};  ///< k1 k2 p1 p2 k3; all zero: none

  /// Throws std::invalid_argument that names the field, its value and its range.
  void check() const;
  [[nodiscard]] bool hasDistortion() const;
  /// The same camera without its distortion (after rectification).
  [[nodiscard]] CameraIntrinsics rectified() const;

  friend bool operator==(const CameraIntrinsics& a, const CameraIntrinsics& b) {
    return a.width == b.width && a.height == b.height && a.fx == b.fx && a.fy == b.fy &&
           a.cx == b.cx && a.cy == b.cy && a.distortion == b.distortion;
  }
  friend bool operator!=(const CameraIntrinsics& a, const CameraIntrinsics& b) { return !(a == b); }
};

/// The tangents (u, v) of the ray that image position (x, y) [px] sees, lens distortion undone
/// (Newton's method on the Brown-Conrady model); empty where the model cannot be inverted. Plain
/// IEEE arithmetic in a fixed order: the same bits on every machine.
[[nodiscard]] std::optional<Eigen::Vector2d> tangentsAt(const CameraIntrinsics& intrinsics,
                                                        double x, double y);

/// Pixel coordinates of a point of the optical frame with z > 0, lens distortion included.
[[nodiscard]] Eigen::Vector2d projectPoint(const CameraIntrinsics& intrinsics,
                                           const Eigen::Vector3d& point);

/// Tangent tables of a camera: `u = (x + dx - cx) / fx`, `v = (y + dy - cy) / fy`, where (dx, dy)
/// is the offset that undoes the lens distortion (paper sec. 3.3). Immutable, cheap to share.
class Camera {
 public:
  /// Throws std::invalid_argument for intrinsics that fail `check()` or a distortion that cannot
  /// be inverted over the image.
  explicit Camera(const CameraIntrinsics& intrinsics);

  [[nodiscard]] const CameraIntrinsics& intrinsics() const { return intrinsics_; }
  [[nodiscard]] int width() const { return intrinsics_.width; }
  [[nodiscard]] int height() const { return intrinsics_.height; }

  /// tan(theta_x) of each pixel, width x height [-].
  [[nodiscard]] ImageView<float> tangentsX() const { return tangents_x_.view(); }
  /// tan(theta_y) of each pixel, width x height [-].
  [[nodiscard]] ImageView<float> tangentsY() const { return tangents_y_.view(); }

  /// The point of optical frame [m] that pixel (x, y) sees at depth `z` [m] along the axis.
  [[nodiscard]] Eigen::Vector3d backProject(int x, int y, double z) const {
    return {z * tangents_x_(x, y), z * tangents_y_(x, y), z};
  }
  /// Pixel coordinates of a point with z > 0, lens distortion included.
  [[nodiscard]] Eigen::Vector2d project(const Eigen::Vector3d& point) const;

 private:
  CameraIntrinsics intrinsics_;
  Image<float> tangents_x_;
  Image<float> tangents_y_;
};

}  // namespace planecloud

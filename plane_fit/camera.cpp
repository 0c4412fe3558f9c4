// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/plane_fit/camera.h"

#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>

namespace planecloud {
namespace {

constexpr int kMaxNewtonSteps = 30;
constexpr double kMaxResidual = 1e-9;  // [-], a millionth of a pixel

void checkField(const std::string& name, double value, double low, double high) {
  if (value >= low && value <= high) return;
  std::ostringstream text;
  text << "camera " << name << " = " << value << ": must be in [" << low << ", " << high << "]";
  throw std::invalid_argument(text.str());
}

struct Distorted {
  double x;
  double y;
  double x_u, x_v, y_u, y_v;  // derivatives
};

/// Brown-Conrady: undistorted tangents to distorted ones, with the Jacobian.
Distorted distort(const std::array<double, 5>& k, double u, double v) {
  const double r2 = u * u + v * v;
  const double radial = 1.0 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]));
  const double slope = 2.0 * (k[0] + r2 * (2.0 * k[1] + r2 * 3.0 * k[4]));  // d radial / (u du)
  Distorted d{};
  d.x = u * radial + 2.0 * k[2] * u * v + k[3] * (r2 + 2.0 * u * u);
  d.y = v * radial + k[2] * (r2 + 2.0 * v * v) + 2.0 * k[3] * u * v;
  d.x_u = radial + u * u * slope + 2.0 * k[2] * v + 6.0 * k[3] * u;
  d.x_v = u * v * slope + 2.0 * k[2] * u + 2.0 * k[3] * v;
  d.y_u = d.x_v;
  d.y_v = radial + v * v * slope + 6.0 * k[2] * v + 2.0 * k[3] * u;
  return d;
}

}  // namespace

void CameraIntrinsics::check() const {
  checkField("width", width, 16, 8192);
  checkField("height", height, 16, 8192);
  checkField("fx", fx, 1.0, 1e5);
  checkField("fy", fy, 1.0, 1e5);
  checkField("cx", cx, -8192.0, 16384.0);
  checkField("cy", cy, -8192.0, 16384.0);
  static const char* const kNames[] = {"k1", "k2", "p1", "p2", "k3"};
  for (std::size_t i = 0; i < distortion.size(); ++i) {
    checkField(kNames[i], distortion[i], -1e3, 1e3);
  }
}

bool CameraIntrinsics::hasDistortion() const { return distortion != std::array<double, 5>{}; }

CameraIntrinsics CameraIntrinsics::rectified() const {
  CameraIntrinsics result = *this;
  result.distortion = {};
  return result;
}

std::optional<Eigen::Vector2d> tangentsAt(const CameraIntrinsics& intrinsics, double x, double y) {
  const double target_u = (x - intrinsics.cx) / intrinsics.fx;
  const double target_v = (y - intrinsics.cy) / intrinsics.fy;
  if (!intrinsics.hasDistortion()) return Eigen::Vector2d(target_u, target_v);
  double u = target_u;
  double v = target_v;
  for (int step = 0; step < kMaxNewtonSteps; ++step) {
    const Distorted d = distort(intrinsics.distortion, u, v);
    const double det = d.x_u * d.y_v - d.x_v * d.y_u;
    if (!(det > 1e-6)) return std::nullopt;  // folded: two rays would fall on one pixel
    const double error_u = d.x - target_u;
    const double error_v = d.y - target_v;
    if (std::abs(error_u) < kMaxResidual && std::abs(error_v) < kMaxResidual) {
      return Eigen::Vector2d(u, v);
    }
    u -= (d.y_v * error_u - d.x_v * error_v) / det;
    v -= (d.x_u * error_v - d.y_u * error_u) / det;
  }
  return std::nullopt;
}

Camera::Camera(const CameraIntrinsics& intrinsics) : intrinsics_(intrinsics) {
  intrinsics_.check();
  tangents_x_.resize(width(), height());
  tangents_y_.resize(width(), height());
  for (int y = 0; y < height(); ++y) {
    for (int x = 0; x < width(); ++x) {
      const std::optional<Eigen::Vector2d> tangents = tangentsAt(intrinsics_, x, y);
      if (!tangents) {
        throw std::invalid_argument("camera distortion cannot be inverted at pixel (" +
                                    std::to_string(x) + ", " + std::to_string(y) +
                                    "): check the calibration or use rectified images");
      }
      tangents_x_(x, y) = static_cast<float>(tangents->x());
      tangents_y_(x, y) = static_cast<float>(tangents->y());
    }
  }
}

Eigen::Vector2d projectPoint(const CameraIntrinsics& intrinsics, const Eigen::Vector3d& point) {
  const Distorted d = distort(intrinsics.distortion, point.x() / point.z(), point.y() / point.z());
  return {intrinsics.fx * d.x + intrinsics.cx, intrinsics.fy * d.y + intrinsics.cy};
}

Eigen::Vector2d Camera::project(const Eigen::Vector3d& point) const {
  return projectPoint(intrinsics_, point);
}

}  // namespace planecloud

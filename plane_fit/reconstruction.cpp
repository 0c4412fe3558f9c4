// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/plane_fit/reconstruction.h"

#include <Eigen/Geometry>
#include <limits>
#include <stdexcept>

namespace planecloud {
namespace {

void checkCamera(const PlaneCloud& cloud, const Camera& camera) {
  if (cloud.camera == camera.intrinsics()) return;
  throw std::invalid_argument(
      "a plane cloud is reconstructed with its own camera: make it from PlaneCloud::camera");
}

/// True as well where no mask tells.
bool hadDepth(const PlaneCloud& cloud, int x, int y) {
  return cloud.mask.empty() || cloud.mask(x, y) != 0;
}

int roundUpTo(int value, int step) { return (value + step - 1) / step * step; }

}  // namespace

Image<float> reconstructDepth(const PlaneCloud& cloud, const Camera& camera) {
  checkCamera(cloud, camera);
  Image<float> depth(camera.width(), camera.height(), std::numeric_limits<float>::quiet_NaN());
  for (const PlanarTile& tile : cloud.tiles) {
    for (int y = tile.rect.y; y < tile.rect.y + tile.rect.height; ++y) {
      for (int x = tile.rect.x; x < tile.rect.x + tile.rect.width; ++x) {
        const float z = tile.depthAt(camera.tangentsX()(x, y), camera.tangentsY()(x, y));
        if (z > 0.0F && hadDepth(cloud, x, y)) depth(x, y) = z;
      }
    }
  }
  return depth;
}

std::vector<Eigen::Vector3f> reconstructPoints(const PlaneCloud& cloud, const Camera& camera,
                                               int step) {
  checkCamera(cloud, camera);
  if (step < 1) throw std::invalid_argument("step of reconstructPoints: must be at least 1");
  std::vector<Eigen::Vector3f> points;
  for (const PlanarTile& tile : cloud.tiles) {
    for (int y = roundUpTo(tile.rect.y, step); y < tile.rect.y + tile.rect.height; y += step) {
      for (int x = roundUpTo(tile.rect.x, step); x < tile.rect.x + tile.rect.width; x += step) {
        const float u = camera.tangentsX()(x, y);
        const float v = camera.tangentsY()(x, y);
        const float z = tile.depthAt(u, v);
        if (z > 0.0F && hadDepth(cloud, x, y)) points.emplace_back(z * u, z * v, z);
      }
    }
  }
  return points;
}

std::optional<std::array<Eigen::Vector3d, 4>> tileCorners(const PlanarTile& tile,
                                                          const CameraIntrinsics& camera,
                                                          double max_depth) {
  const double left = tile.rect.x - 0.5;
  const double top = tile.rect.y - 0.5;
  const double right = left + tile.rect.width;
  const double bottom = top + tile.rect.height;
  const double image[4][2] = {{left, top}, {right, top}, {right, bottom}, {left, bottom}};
  const Eigen::Vector3d inverse_depth = tile.inverse_depth.cast<double>();
  std::array<Eigen::Vector3d, 4> corners;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector2d pinhole((image[i][0] - camera.cx) / camera.fx,
                                  (image[i][1] - camera.cy) / camera.fy);
    const Eigen::Vector2d tangents = tangentsAt(camera, image[i][0], image[i][1]).value_or(pinhole);
    const double q = inverse_depth.dot(tangents.homogeneous());
    if (!(q * max_depth > 1.0)) return std::nullopt;
    corners[i] = tangents.homogeneous() / q;
  }
  return corners;
}

}  // namespace planecloud

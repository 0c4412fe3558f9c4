// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/backend_node/view_sketch.h"

namespace planecloud {
namespace {

constexpr int kColumns = 8;
constexpr int kRows = 6;

/// Where the plane is met along the ray of a pixel, appended when it lies ahead.
void addSample(const PlanarTile& tile, double x, double y, ViewSketch& sketch) {
  const CameraIntrinsics& k = sketch.camera;
  const Eigen::Vector3d coefficients = tile.inverse_depth.cast<double>();
  const Eigen::Vector3d ray((x - k.cx) / k.fx, (y - k.cy) / k.fy, 1.0);
  const double inverse_depth = coefficients.dot(ray);
  if (!(inverse_depth > 0.0)) return;
  const Eigen::Vector3d normal = -coefficients.normalized();
  sketch.samples.push_back({(ray / inverse_depth).cast<Eigen::half>(), normal.cast<Eigen::half>()});
}

}  // namespace

ViewSketch sketchView(const PlaneCloud& planes) {
  ViewSketch sketch;
  sketch.camera = planes.camera;
  for (const PlanarTile& tile : planes.tiles) {
    for (int row = 0; row < kRows; ++row) {
      const int y = (2 * row + 1) * planes.camera.height / (2 * kRows);
      if (y < tile.rect.y || y >= tile.rect.y + tile.rect.height) continue;
      for (int column = 0; column < kColumns; ++column) {
        const int x = (2 * column + 1) * planes.camera.width / (2 * kColumns);
        if (x >= tile.rect.x && x < tile.rect.x + tile.rect.width) addSample(tile, x, y, sketch);
      }
    }
  }
  sketch.samples.shrink_to_fit();
  return sketch;
}

}  // namespace planecloud

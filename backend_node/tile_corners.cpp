// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/backend_node/tile_corners.h"

#include <algorithm>

namespace planecloud_slam {

std::optional<std::array<Eigen::Vector3d, 4>> tileCorners(const Camera& camera,
                                                          const PlanarTile& tile,
                                                          double max_depth) {
  const int left = tile.rect.x;
  const int top = tile.rect.y;
  const int right = std::min(left + tile.rect.width, camera.width() - 1);
  const int bottom = std::min(top + tile.rect.height, camera.height() - 1);
  const std::array<Eigen::Vector2i, 4> pixels{
      {{left, top}, {left, bottom}, {right, bottom}, {right, top}}};
  std::array<Eigen::Vector3d, 4> corners;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const int x = pixels[i].x();
    const int y = pixels[i].y();
    const Eigen::Vector3d tangents(camera.tangentsX()(x, y), camera.tangentsY()(x, y), 1.0);
    const double inverse_depth = tile.inverse_depth.cast<double>().dot(tangents);
    if (!(inverse_depth * max_depth > 1.0)) return std::nullopt;
    corners[i] = tangents / inverse_depth;
  }
  return corners;
}

}  // namespace planecloud_slam

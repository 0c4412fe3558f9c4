// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/frontend_node/plane_landmarks.h"

#include <algorithm>
#include <limits>
#include <memory>

namespace planecloud {
namespace {

/// Smaller tiles know no more than the window around a point [px].
constexpr int kLeastSide = 8;

}  // namespace

PlaneLandmarks::PlaneLandmarks(const CameraIntrinsics& camera, const QuadtreeFitterOptions& options)
    : camera_(camera),
      fitter_(std::make_shared<const Camera>(camera), options),
      tiles_(camera.width, camera.height, 0) {}

void PlaneLandmarks::assign(ImageView<float> depth) {
  cloud_ = fitter_.fit(depth);
  std::fill(tiles_.begin(), tiles_.end(), std::uint16_t{0});
  std::uint16_t number = 0;
  for (const PlanarTile& tile : cloud_.tiles) {
    if (number == std::numeric_limits<std::uint16_t>::max()) break;
    ++number;
    const TileRect& rect = tile.rect;
    if (std::min(rect.width, rect.height) < kLeastSide) continue;
    for (int y = rect.y; y < rect.y + rect.height; ++y) {
      std::fill_n(tiles_.row(y) + rect.x, rect.width, number);
    }
  }
}

const Eigen::Vector3f* PlaneLandmarks::find(float u, float v) const {
  const double x = camera_.fx * static_cast<double>(u) + camera_.cx + 0.5;
  const double y = camera_.fy * static_cast<double>(v) + camera_.cy + 0.5;
  if (!(x >= 0.0 && x < camera_.width && y >= 0.0 && y < camera_.height)) return nullptr;
  const std::uint16_t number = tiles_(static_cast<int>(x), static_cast<int>(y));
  return number == 0 ? nullptr : &cloud_.tiles[number - 1U].inverse_depth;
}

}  // namespace planecloud

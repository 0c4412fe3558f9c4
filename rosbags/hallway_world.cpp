// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/rosbags/hallway_world.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "planecloud_slam/rosbags/hallway_builder.h"

namespace planecloud {
namespace {

constexpr double kLightCell = 0.25;               // [m]
const Eigen::Vector2d kLightOrigin(-2.0, -10.0);  // [m]
constexpr int kLightColumns = 74;
constexpr int kLightRows = 74;

/// Horizontal distance from a point to a solid's outline, 0 inside.
double distanceTo(const Solid& solid, double x, double y) {
  const double dx = x - solid.centre.x();
  const double dy = y - solid.centre.y();
  if (solid.shape == Solid::Shape::kCylinder) {
    return std::max(0.0, std::hypot(dx, dy) - solid.half.x());
  }
  const double along = std::cos(solid.yaw) * dx + std::sin(solid.yaw) * dy;
  const double across = -std::sin(solid.yaw) * dx + std::cos(solid.yaw) * dy;
  return std::hypot(std::max(0.0, std::abs(along) - solid.half.x()),
                    std::max(0.0, std::abs(across) - solid.half.y()));
}

}  // namespace

HallwayWorld::HallwayWorld(std::uint64_t seed) {
  HallwayBuilder builder(seed);
  const std::vector<Eigen::Vector2d> lamps = buildWalls(builder);
  furnish(builder);
  solids_ = builder.takeSolids();
  materials_ = builder.takeMaterials();
  modulations_ = builder.takeModulations();
  pictures_ = builder.takePictures();
  bakeLight(lamps);
}

void HallwayWorld::bakeLight(const std::vector<Eigen::Vector2d>& lamps) {
  light_ = Image<float>(kLightColumns, kLightRows);
  for (int row = 0; row < kLightRows; ++row) {
    for (int column = 0; column < kLightColumns; ++column) {
      const Eigen::Vector2d place = kLightOrigin + kLightCell * Eigen::Vector2d(column, row);
      double light = 0.76;
      for (const Eigen::Vector2d& lamp : lamps) {
        light += 0.26 * std::exp(-(place - lamp).squaredNorm() / (2.0 * 1.0 * 1.0));
      }
      light_(column, row) = static_cast<float>(light);
    }
  }
}

float HallwayWorld::light(float x, float y) const {
  const float column = std::clamp((x - static_cast<float>(kLightOrigin.x())) / float{kLightCell},
                                  0.0F, float{kLightColumns - 1.01F});
  const float row = std::clamp((y - static_cast<float>(kLightOrigin.y())) / float{kLightCell}, 0.0F,
                               float{kLightRows - 1.01F});
  const int c = static_cast<int>(column);
  const int r = static_cast<int>(row);
  const float fc = column - static_cast<float>(c);
  const float fr = row - static_cast<float>(r);
  return (light_(c, r) * (1 - fc) + light_(c + 1, r) * fc) * (1 - fr) +
         (light_(c, r + 1) * (1 - fc) + light_(c + 1, r + 1) * fc) * fr;
}

double HallwayWorld::clearance(double x, double y, double height) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Solid& solid : solids_) {
    const bool in_reach =
        solid.centre.z() + solid.half.z() > 1e-3 && solid.centre.z() - solid.half.z() < height;
    if (in_reach) nearest = std::min(nearest, distanceTo(solid, x, y));
  }
  return nearest;
}

}  // namespace planecloud

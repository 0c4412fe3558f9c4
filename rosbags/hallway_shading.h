// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "planecloud_slam/rosbags/hallway_world.h"
#include "planecloud_slam/rosbags/placed_solid.h"

namespace planecloud {

/// Angle between neighbouring pixels as tangents: 1 / fx and 1 / fy.
struct PixelPitch {
  float x = 0.0F;
  float y = 0.0F;
};

/// Colour of a surface, 0..255 per channel: texture averaged over the pixel, light of the place,
/// and a brightness that belongs to the direction the surface faces. The same from wherever it is
/// seen.
[[nodiscard]] Eigen::Array3f shade(const HallwayWorld& world, const PlacedSolid& placed,
                                   const SurfaceHit& hit, const PixelPitch& pitch);

}  // namespace planecloud

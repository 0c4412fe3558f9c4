// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/plane_fit/tile_quantiser.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace planecloud {
namespace {

double asSingle(double value) { return static_cast<double>(static_cast<float>(value)); }

CameraIntrinsics rounded(CameraIntrinsics camera) {
  camera.fx = asSingle(camera.fx);
  camera.fy = asSingle(camera.fy);
  camera.cx = asSingle(camera.cx);
  camera.cy = asSingle(camera.cy);
  for (double& k : camera.distortion) k = asSingle(k);
  return camera;
}

/// Nearest multiple of 2^bits, half away from zero, within +-limit.
std::int32_t roundTo(double value, int bits, double limit) {
  const double step = static_cast<double>(1 << bits);
  // Steps are powers of two: the product with the inverse is exact.
  const double steps = std::floor(std::abs(value) * (1.0 / step) + 0.5);
  const auto magnitude = static_cast<std::int32_t>(std::min(steps * step, limit));
  return value < 0.0 ? -magnitude : magnitude;
}

/// Half of a multiple of 2^bits, towards zero, again such a multiple.
std::int32_t halved(std::int32_t value, int bits) { return value / (2 << bits) * (1 << bits); }

}  // namespace

TileQuantiser::TileQuantiser(const CameraIntrinsics& camera, const QuadtreeGrid& grid, int step)
    : camera_(rounded(camera)),
      finest_level_(grid.levels() - 1),
      unit_(static_cast<double>(step) * kStepUnit / static_cast<double>(1 << kUnitBits)) {}

int TileQuantiser::stepBits(int level) const {
  return std::max(0, kUnitBits - (finest_level_ - level));
}

std::optional<TileQuantiser::Frame> TileQuantiser::frame(const TileRect& rect) const {
  const std::optional<Eigen::Vector2d> center =
      tangentsAt(camera_, rect.x + 0.5 * (rect.width - 1), rect.y + 0.5 * (rect.height - 1));
  if (!center) return std::nullopt;
  return Frame{center->x(), center->y(), 0.5 * rect.width / camera_.fx,
               0.5 * rect.height / camera_.fy};
}

PlanarTile TileQuantiser::toTile(const QuantisedPlane& plane, const TileRect& rect,
                                 const Frame& frame) const {
  const double alpha = unit_ * plane.right / frame.half_width;
  const double beta = unit_ * plane.down / frame.half_height;
  const double gamma = unit_ * plane.center - alpha * frame.u - beta * frame.v;
  PlanarTile tile;
  tile.rect = rect;
  tile.inverse_depth << static_cast<float>(alpha), static_cast<float>(beta),
      static_cast<float>(gamma);
  return tile;
}

Eigen::Vector3d TileQuantiser::inUnits(const PlanarTile& tile, const Frame& frame) const {
  const double alpha = tile.inverse_depth.x();
  const double beta = tile.inverse_depth.y();
  const double gamma = tile.inverse_depth.z();
  return {(alpha * frame.u + beta * frame.v + gamma) / unit_, alpha * frame.half_width / unit_,
          beta * frame.half_height / unit_};
}

QuantisedPlane TileQuantiser::round(const Eigen::Vector3d& units, int level) const {
  const int bits = stepBits(level);
  const double limit = std::floor(kMaxInverseDepth / unit_);
  return {roundTo(units.x(), bits, limit), roundTo(units.y(), bits + 1, limit),
          roundTo(units.z(), bits + 1, limit)};
}

bool TileQuantiser::isStable(const QuantisedPlane& plane, const TileRect& rect, const Frame& frame,
                             int level) const {
  if (plane.center - std::abs(plane.right) - std::abs(plane.down) <= 0) return false;
  return round(inUnits(toTile(plane, rect, frame), frame), level) == plane;
}

std::optional<QuantisedPlane> TileQuantiser::quantise(const PlanarTile& tile, int level) const {
  const std::optional<Frame> at = frame(tile.rect);
  if (!at || !tile.inverse_depth.allFinite()) return std::nullopt;
  const Eigen::Vector3d units = inUnits(tile, *at);
  // At the centres of the corner pixels.
  const double nearest = units.x() - std::abs(units.y()) * (1.0 - 1.0 / tile.rect.width) -
                         std::abs(units.z()) * (1.0 - 1.0 / tile.rect.height);
  if (!(nearest > 0.0)) return std::nullopt;
  QuantisedPlane plane = round(units, level);
  // Rounding, or the pixel's own width, may tip a steep plane behind the camera: flatten it.
  const int slope_bits = stepBits(level) + 1;
  while ((plane.right != 0 || plane.down != 0) && !isStable(plane, tile.rect, *at, level)) {
    std::int32_t& steeper = std::abs(plane.right) > std::abs(plane.down) ? plane.right : plane.down;
    steeper = halved(steeper, slope_bits);
  }
  if (!isStable(plane, tile.rect, *at, level)) return std::nullopt;
  return plane;
}

std::optional<PlanarTile> TileQuantiser::dequantise(const QuantisedPlane& plane,
                                                    const TileRect& rect, int level) const {
  const std::optional<Frame> at = frame(rect);
  if (!at || !isStable(plane, rect, *at, level)) return std::nullopt;
  return toTile(plane, rect, *at);
}

}  // namespace planecloud

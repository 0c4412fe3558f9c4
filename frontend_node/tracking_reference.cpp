// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/frontend_node/tracking_reference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace planecloud {
namespace {

/// Inverse depths of one surface differ by less than this share within the fitted window.
constexpr float kEdgeSpread = 0.1F;
constexpr int kWindowRadius = 2;
constexpr int kMinWindowPixels = 10;

/// Inverse depth around a pixel: value [1/m] and slope [1/m per pixel].
struct SurfaceFit {
  float q;
  float q_x;
  float q_y;
};

/// True when a direct neighbour is clearly nearer: the pixel's depth and grey may belong to either
/// side, and what it shows will be covered or uncovered by the next motion.
bool isBehindEdge(const Image<GreyDepth>& pixels, int x, int y) {
  const float limit = (1.0F + kEdgeSpread) * pixels(x, y).inverse_depth;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      if (pixels(x + dx, y + dy).inverse_depth > limit) return true;
    }
  }
  return false;
}

/// Regression of inverse depth on the window around (x, y), over the pixels of the same surface.
std::optional<SurfaceFit> fitSurface(const Image<GreyDepth>& pixels, int x, int y) {
  const float centre = pixels(x, y).inverse_depth;
  const float tolerance = kEdgeSpread * centre;
  float n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0, syy = 0, sq = 0, sxq = 0, syq = 0;
  for (int dy = -kWindowRadius; dy <= kWindowRadius; ++dy) {
    const GreyDepth* row = pixels.row(y + dy) + x;
    const auto fy = static_cast<float>(dy);
    for (int dx = -kWindowRadius; dx <= kWindowRadius; ++dx) {
      const float q = row[dx].inverse_depth - centre;
      if (std::abs(q) > tolerance) continue;
      const auto fx = static_cast<float>(dx);
      n += 1.0F, sx += fx, sy += fy, sq += q;
      sxx += fx * fx, sxy += fx * fy, syy += fy * fy;
      sxq += fx * q, syq += fy * q;
    }
  }
  if (n < static_cast<float>(kMinWindowPixels)) return std::nullopt;
  sxx -= sx * sx / n, sxy -= sx * sy / n, syy -= sy * sy / n;
  sxq -= sx * sq / n, syq -= sy * sq / n;
  const float determinant = sxx * syy - sxy * sxy;
  if (determinant < 0.05F * n * n) return std::nullopt;
  const float q_x = (syy * sxq - sxy * syq) / determinant;
  const float q_y = (sxx * syq - sxy * sxq) / determinant;
  return SurfaceFit{centre + (sq - q_x * sx - q_y * sy) / n, q_x, q_y};
}

/// Squared gradient of grey [(levels/px)^2]; 0 on the border the windows cannot reach.
Image<float> squaredGradients(const Image<GreyDepth>& pixels) {
  Image<float> squares(pixels.width(), pixels.height(), 0.0F);
  for (int y = kWindowRadius; y < pixels.height() - kWindowRadius; ++y) {
    const GreyDepth* above = pixels.row(y - 1);
    const GreyDepth* row = pixels.row(y);
    const GreyDepth* below = pixels.row(y + 1);
    for (int x = kWindowRadius; x < pixels.width() - kWindowRadius; ++x) {
      const float gx = 0.5F * (row[x + 1].grey - row[x - 1].grey);
      const float gy = 0.5F * (below[x].grey - above[x].grey);
      squares(x, y) = gx * gx + gy * gy;
    }
  }
  return squares;
}

/// The squared gradient that at most `share` of the pixels exceed, never below `floor` squared.
float gradientThreshold(const Image<float>& squares, double share, double floor) {
  constexpr float kBinsPerLevel = 4.0F;
  std::array<std::size_t, 512> histogram{};
  for (const float square : squares) {
    const auto bin = static_cast<std::size_t>(kBinsPerLevel * std::sqrt(square));
    ++histogram[std::min(bin, histogram.size() - 1)];
  }
  const auto allowed = static_cast<std::size_t>(share * static_cast<double>(squares.size()));
  std::size_t kept = 0;
  std::size_t bin = histogram.size();
  while (bin > 0 && kept + histogram[bin - 1] <= allowed) kept += histogram[--bin];
  const float threshold =
      std::max(static_cast<float>(bin) / kBinsPerLevel, static_cast<float>(floor));
  return threshold * threshold;
}

void appendPoint(const RgbdLevel& level, int x, int y, const SurfaceFit& fit,
                 ReferencePoints& points) {
  const LevelCamera& camera = level.camera;
  const Image<GreyDepth>& pixels = level.pixels;
  points.u.push_back((static_cast<float>(x) - camera.cx) / camera.fx);
  points.v.push_back((static_cast<float>(y) - camera.cy) / camera.fy);
  points.q.push_back(fit.q);
  points.q_u.push_back(fit.q_x * camera.fx);
  points.q_v.push_back(fit.q_y * camera.fy);
  points.grey.push_back(pixels(x, y).grey);
  points.grey_u.push_back(0.5F * camera.fx * (pixels(x + 1, y).grey - pixels(x - 1, y).grey));
  points.grey_v.push_back(0.5F * camera.fy * (pixels(x, y + 1).grey - pixels(x, y - 1).grey));
}

void pad(ReferencePoints& points) {
  points.count = points.u.size();
  const std::size_t lanes = ReferencePoints::kLanes;
  const std::size_t padded = (points.count + lanes - 1) / lanes * lanes;
  for (std::vector<float>* array : {&points.u, &points.v, &points.q, &points.grey, &points.grey_u,
                                    &points.grey_v, &points.q_u, &points.q_v}) {
    array->resize(padded, 0.0F);
  }
  points.block.resize(padded, 0);
}

ReferencePoints choosePoints(const RgbdLevel& level, double textured_share, int block_side,
                             const DenseTrackerOptions& options) {
  const Image<GreyDepth>& pixels = level.pixels;
  const Image<float> squares = squaredGradients(pixels);
  const float threshold = gradientThreshold(squares, textured_share, options.min_gradient);
  const int side = std::max(block_side, 1);
  const int blocks_across = (pixels.width() + side - 1) / side;
  ReferencePoints points;
  for (int y = kWindowRadius; y < pixels.height() - kWindowRadius; ++y) {
    for (int x = kWindowRadius; x < pixels.width() - kWindowRadius; ++x) {
      const bool on_grid = x % options.flat_grid_step == 0 && y % options.flat_grid_step == 0;
      if (!(on_grid || squares(x, y) > threshold)) continue;
      if (!(pixels(x, y).inverse_depth > 0.0F) || isBehindEdge(pixels, x, y)) continue;
      const std::optional<SurfaceFit> fit = fitSurface(pixels, x, y);
      if (!fit) continue;
      appendPoint(level, x, y, *fit, points);
      points.block.push_back(static_cast<std::uint16_t>(y / side * blocks_across + x / side));
    }
  }
  points.blocks = blocks_across * ((pixels.height() + side - 1) / side);
  pad(points);
  return points;
}

}  // namespace

TrackingReference::TrackingReference(const RgbdPyramid& pyramid,
                                     const DenseTrackerOptions& options) {
  double share = options.textured_share;
  int block_side = options.information_block;
  for (const RgbdLevel& level : pyramid.levels()) {
    levels_.push_back(choosePoints(level, std::min(share, 1.0), block_side, options));
    share *= 2.0;
    block_side /= 2;
  }
}

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/plane_fit/tile_fitter.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace planecloud {
namespace {

/// Planes are only kept where their inverse depth is at least this inside the tile [1/m]: 64 m.
constexpr float kMinInverseDepth = 1.0F / 64.0F;
/// Rows of a tile whose error is summed before the tile can be given up.
constexpr int kRowsAtOnce = 16;
/// Mean |x| over root mean square of a normal distribution.
constexpr float kMeanOverRms = 0.798F;

}  // namespace

std::optional<TileFit> TileFitter::fit(const QuadtreeNode& node) const {
  const int count = pyramid_.count(node);
  if (count == 0 || count < options_.min_fill * pyramid_.area(node)) return std::nullopt;
  const TileRect rect = pyramid_.grid().rect(node);
  const Eigen::Vector2f& origin = pyramid_.origin(node);
  const float mean_depth = 1.0F / pyramid_.meanInverseDepth(node);
  if (options_.corner_check != CornerCheck::kNone) {
    const std::optional<Corners> corners = findCorners(rect);
    if (!corners || !isPlanar(*corners, origin, allowedError(mean_depth))) return std::nullopt;
  }
  const Eigen::Vector3f plane = pyramid_.regress(node).cast<float>();
  if (!isInFront(rect, plane)) return std::nullopt;
  return measure(rect, plane, origin, count, mean_depth);
}

TileFit TileFitter::measure(const QuadtreeNode& node) const {
  TileFit fit;
  fit.plane = pyramid_.regress(node).cast<float>();
  fit.count = pyramid_.count(node);
  const ResidualSums sums = pyramid_.residuals(pyramid_.grid().rect(node), fit.plane);
  fit.depth_sum = sums.depth;
  fit.point_plane_sum = planeDistance(node, fit.plane) * sums.relative;
  return fit;
}

TileFit TileFitter::estimate(const QuadtreeNode& node) const {
  return estimate(node, pyramid_.regress(node).cast<float>());
}

TileFit TileFitter::estimate(const QuadtreeNode& node, const Eigen::Vector3f& plane) const {
  TileFit fit;
  fit.plane = plane;
  fit.count = pyramid_.count(node);
  const float depth = 1.0F / pyramid_.meanInverseDepth(node);
  const float error = kMeanOverRms * std::sqrt(pyramid_.meanSquare(node, fit.plane)) * depth;
  fit.depth_sum = fit.count * error * depth;
  fit.point_plane_sum = fit.count * error * planeDistance(node, fit.plane);
  return fit;
}

std::optional<float> TileFitter::distortion(const QuadtreeNode& node) const {
  const int count = pyramid_.count(node);
  if (count == 0 || count < options_.min_fill * pyramid_.area(node)) return std::nullopt;
  const TileRect rect = pyramid_.grid().rect(node);
  if (options_.corner_check != CornerCheck::kNone && !findCorners(rect)) return std::nullopt;
  const Eigen::Vector3f plane = pyramid_.regress(node).cast<float>();
  if (!isInFront(rect, plane)) return std::nullopt;
  const TileFit fit = estimate(node, plane);
  const double sum = options_.along_ray_test ? fit.depth_sum : fit.point_plane_sum;
  return static_cast<float>(sum) / allowedError(1.0F / pyramid_.meanInverseDepth(node));
}

float TileFitter::planeDistance(const QuadtreeNode& node, const Eigen::Vector3f& plane) const {
  const float gamma = plane.z() - plane.head<2>().dot(pyramid_.origin(node));
  return 1.0F / Eigen::Vector3f(plane.x(), plane.y(), gamma).norm();
}

std::optional<TileFitter::Corners> TileFitter::findCorners(const TileRect& rect) const {
  const bool exact = options_.corner_check == CornerCheck::kExact;
  const int window = exact ? 1 : std::min(4, (std::min(rect.width, rect.height) + 1) / 2);
  const int right = rect.x + rect.width - 1;
  const int bottom = rect.y + rect.height - 1;
  const auto find = [&](int x, int y, int step_x, int step_y, Corner& corner) {
    corner = findCorner(x, y, step_x, step_y, window);
    return corner.q != 0.0F;
  };
  Corners corners;
  const bool found =
      find(rect.x, rect.y, 1, 1, corners[0]) && find(right, rect.y, -1, 1, corners[1]) &&
      find(rect.x, bottom, 1, -1, corners[2]) && find(right, bottom, -1, -1, corners[3]);
  if (!found) return std::nullopt;
  return corners;
}

TileFitter::Corner TileFitter::findCorner(int x, int y, int step_x, int step_y, int window) const {
  const float corner = pyramid_.inverseDepth(x, y);
  if (corner != 0.0F) {
    const Eigen::Vector2f tangents = pyramid_.tangents(x, y);
    return {tangents.x(), tangents.y(), corner};
  }
  // Diagonals inwards from the corner: the nearest valid pixel comes first.
  for (int ring = 1; ring <= 2 * (window - 1); ++ring) {
    for (int i = std::max(0, ring - window + 1); i <= std::min(ring, window - 1); ++i) {
      const int px = x + i * step_x;
      const int py = y + (ring - i) * step_y;
      const float q = pyramid_.inverseDepth(px, py);
      if (q == 0.0F) continue;
      const Eigen::Vector2f tangents = pyramid_.tangents(px, py);
      return {tangents.x(), tangents.y(), q};
    }
  }
  return {};
}

bool TileFitter::isPlanar(const Corners& c, const Eigen::Vector2f& origin, float allowed) const {
  if (options_.planarity_factor == 0.0) return true;
  const float u1 = c[1].u - c[0].u, v1 = c[1].v - c[0].v, q1 = c[1].q - c[0].q;
  const float u2 = c[2].u - c[0].u, v2 = c[2].v - c[0].v, q2 = c[2].q - c[0].q;
  const float det = u1 * v2 - u2 * v1;
  if (det == 0.0F) return true;  // a single row or column has no fourth corner
  const float alpha = (q1 * v2 - q2 * v1) / det;
  const float beta = (u1 * q2 - u2 * q1) / det;
  const float fourth = c[0].q + alpha * (c[3].u - c[0].u) + beta * (c[3].v - c[0].v);
  const float gamma = c[0].q - alpha * (c[0].u + origin.x()) - beta * (c[0].v + origin.y());
  const float norm = std::sqrt(alpha * alpha + beta * beta + gamma * gamma);
  const float distance = std::abs(c[3].q - fourth) / (c[3].q * norm);
  return distance <= static_cast<float>(options_.planarity_factor) * allowed;
}

bool TileFitter::isInFront(const TileRect& rect, const Eigen::Vector3f& plane) const {
  const int right = rect.x + rect.width - 1;
  const int bottom = rect.y + rect.height - 1;
  float nearest = std::numeric_limits<float>::infinity();
  for (const int y : {rect.y, bottom}) {
    for (const int x : {rect.x, right}) {
      nearest = std::min(nearest, plane.head<2>().dot(pyramid_.tangents(x, y)) + plane.z());
    }
  }
  return nearest >= kMinInverseDepth;
}

float TileFitter::allowedError(float depth) const {
  const auto tolerance = static_cast<float>(options_.tolerance);
  switch (options_.acceptance) {
    case AcceptanceRule::kFixed:
      return tolerance;
    case AcceptanceRule::kLinearInDepth:
      return tolerance * depth;
    case AcceptanceRule::kNoiseScaled:
      break;
  }
  return tolerance * depth * depth;
}

std::optional<TileFit> TileFitter::measure(const TileRect& rect, const Eigen::Vector3f& plane,
                                           const Eigen::Vector2f& origin, double count,
                                           float mean_depth) const {
  const double d =
      1.0 / Eigen::Vector3f(plane.x(), plane.y(), plane.z() - plane.head<2>().dot(origin)).norm();
  const double allowed_sum = count * allowedError(mean_depth);
  const bool noise_scaled = options_.acceptance == AcceptanceRule::kNoiseScaled;
  TileFit fit;
  fit.plane = plane;
  fit.count = count;
  double inverse_depth_sum = 0.0;
  for (int y = 0; y < rect.height; y += kRowsAtOnce) {
    const ResidualSums sums = pyramid_.residuals(
        {rect.x, rect.y + y, rect.width, std::min(kRowsAtOnce, rect.height - y)}, plane);
    inverse_depth_sum += sums.inverse_depth;
    fit.depth_sum += sums.depth;
    fit.point_plane_sum += d * sums.relative;
    const bool off_ray =
        noise_scaled ? inverse_depth_sum > count * options_.tolerance : fit.depth_sum > allowed_sum;
    if (fit.point_plane_sum > allowed_sum || (options_.along_ray_test && off_ray)) {
      return std::nullopt;
    }
  }
  return fit;
}

}  // namespace planecloud

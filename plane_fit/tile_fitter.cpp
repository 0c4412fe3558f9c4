// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/plane_fit/tile_fitter.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace planecloud {
namespace {

/// Rows of a tile whose error is summed before the tile can be given up.
constexpr int kRowsAtOnce = 16;
/// Mean |x| over root mean square of a normal distribution.
constexpr float kMeanOverRms = 0.798F;
/// The power of depth with which the allowed error grows.
int depthPower(AcceptanceRule rule) {
  switch (rule) {
    case AcceptanceRule::kFixed:
      return 0;
    case AcceptanceRule::kLinearInDepth:
      return 1;
    case AcceptanceRule::kNoiseScaled:
      break;
  }
  return 2;
}

/// Mean error of inverse depth over inverse depth, for noise, about `depth` [m].
float relativeError(const NodePlane& plane, float depth) {
  return kMeanOverRms * std::abs(plane.rms) * depth;
}

Eigen::Vector3f toVector(const NodePlane& plane) { return {plane.alpha, plane.beta, plane.gamma}; }

/// Of a plane about `origin` from the camera [m].
float distance(const Eigen::Vector3f& plane, const Eigen::Vector2f& origin) {
  const float gamma = plane.z() - plane.head<2>().dot(origin);
  return 1.0F / Eigen::Vector3f(plane.x(), plane.y(), gamma).norm();
}

}  // namespace

DistortionRule TileFitter::distortionRule(const QuadtreeFitterOptions& options) {
  return {kMeanOverRms / static_cast<float>(options.tolerance), 2 - depthPower(options.acceptance)};
}

std::optional<TileFit> TileFitter::fit(const QuadtreeNode& node) const {
  const int count = pyramid_.count(node);
  if (count == 0 || count < options_.min_fill * pyramid_.area(node)) return std::nullopt;
  const TileRect rect = pyramid_.grid().rect(node);
  const Eigen::Vector2f& origin = pyramid_.origin(node);
  const float mean_depth = 1.0F / pyramid_.meanInverseDepth(node);
  if (options_.corner_check != CornerCheck::kNone) {
    const auto corners = findCorners(rect);
    if (!corners || !isPlanar(cornersAt(*corners), origin, allowedError(mean_depth))) {
      return std::nullopt;
    }
  }
  const NodePlane plane = pyramid_.regress(node);
  if (!isInFront(node, plane)) return std::nullopt;
  return measure(rect, plane, origin, count, mean_depth);
}

TileFit TileFitter::sample(const QuadtreeNode& node, const Eigen::Vector3f& plane) const {
  TileFit fit;
  fit.plane = plane;
  fit.count = pyramid_.count(node);
  const ResidualSums sums = pyramid_.sampleResiduals(node, {plane.x(), plane.y(), plane.z(), 0.0F});
  fit.depth_sum = sums.depth;
  fit.point_plane_sum = planeDistance(node, fit.plane) * sums.relative;
  return fit;
}

TileFit TileFitter::estimate(const QuadtreeNode& node) const {
  const NodePlane plane = pyramid_.regress(node);
  TileFit fit;
  fit.plane = toVector(plane);
  fit.count = pyramid_.count(node);
  const float depth = 1.0F / pyramid_.meanInverseDepth(node);
  fit.depth_sum = fit.count * (relativeError(plane, depth) * depth);
  return fit;
}

double TileFitter::estimatePointPlane(const QuadtreeNode& node, const TileFit& fit) const {
  return fit.depth_sum * pyramid_.meanInverseDepth(node) * planeDistance(node, fit.plane);
}

bool TileFitter::hasEnoughDepth(const QuadtreeNode& node) const {
  const int count = pyramid_.count(node);
  return count > 0 && count >= options_.min_fill * pyramid_.area(node) && hasDepthAtCorners(node);
}

float TileFitter::distortionByPlane(const QuadtreeNode& node) const {
  const NodePlane plane = pyramid_.regress(node);
  if (!isInFront(node, plane)) return -1.0F;
  const float depth = 1.0F / pyramid_.meanInverseDepth(node);
  const float error = relativeError(plane, depth);
  const float scale = options_.along_ray_test ? depth : planeDistance(node, toVector(plane));
  return static_cast<float>(pyramid_.count(node)) * error * scale / allowedError(depth);
}

float TileFitter::planeDistance(const QuadtreeNode& node, const Eigen::Vector3f& plane) const {
  return distance(plane, pyramid_.origin(node));
}

int TileFitter::cornerWindow(const TileRect& rect) const {
  if (options_.corner_check == CornerCheck::kExact) return 1;
  return std::min(4, (std::min(rect.width, rect.height) + 1) / 2);
}

bool TileFitter::hasDepthAtCorners(const QuadtreeNode& node) const {
  if (options_.corner_check == CornerCheck::kNone) return true;
  return pyramid_.hasDepthAtCorners(node, cornerWindow(pyramid_.grid().rect(node)));
}

std::optional<TileFitter::CornerPixels> TileFitter::findCorners(const TileRect& rect) const {
  const int window = cornerWindow(rect);
  const Eigen::Vector2i first(rect.x, rect.y);
  const Eigen::Vector2i last(rect.x + rect.width - 1, rect.y + rect.height - 1);
  CornerPixels corners;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const bool right = i % 2 == 1;
    const bool lower = i / 2 == 1;
    const Eigen::Vector2i corner(right ? last.x() : first.x(), lower ? last.y() : first.y());
    const Eigen::Vector2i inwards(right ? -1 : 1, lower ? -1 : 1);
    const std::optional<Eigen::Vector2i> pixel = nearestDepth(corner, inwards, window);
    if (!pixel) return std::nullopt;
    corners[i] = *pixel;
  }
  return corners;
}

std::optional<Eigen::Vector2i> TileFitter::nearestDepth(const Eigen::Vector2i& corner,
                                                        const Eigen::Vector2i& inwards,
                                                        int window) const {
  // Diagonals inwards from the corner: the nearest valid pixel comes first.
  for (int ring = 0; ring <= 2 * (window - 1); ++ring) {
    for (int i = std::max(0, ring - window + 1); i <= std::min(ring, window - 1); ++i) {
      const Eigen::Vector2i pixel(corner.x() + i * inwards.x(),
                                  corner.y() + (ring - i) * inwards.y());
      if (pyramid_.inverseDepth(pixel.x(), pixel.y()) != 0.0F) return pixel;
    }
  }
  return std::nullopt;
}

TileFitter::Corners TileFitter::cornersAt(const CornerPixels& pixels) const {
  Corners corners;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector2f tangents = pyramid_.tangents(pixels[i].x(), pixels[i].y());
    corners[i] = {tangents.x(), tangents.y(), pyramid_.inverseDepth(pixels[i].x(), pixels[i].y())};
  }
  return corners;
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

bool TileFitter::isInFront(const QuadtreeNode& node, const NodePlane& plane) const {
  if (!std::signbit(plane.rms)) return true;
  const TileRect rect = pyramid_.grid().rect(node);
  const Eigen::Vector3f vector = toVector(plane);
  float nearest = std::numeric_limits<float>::infinity();
  for (const int y : {rect.y, rect.y + rect.height - 1}) {
    for (const int x : {rect.x, rect.x + rect.width - 1}) {
      nearest = std::min(nearest, vector.dot(pyramid_.tangents(x, y).homogeneous()));
    }
  }
  return nearest >= kMinPlaneInverseDepth;
}

float TileFitter::allowedError(float depth) const {
  auto allowed = static_cast<float>(options_.tolerance);
  for (int power = 0; power < depthPower(options_.acceptance); ++power) allowed *= depth;
  return allowed;
}

std::optional<TileFit> TileFitter::measure(const TileRect& rect, const NodePlane& plane,
                                           const Eigen::Vector2f& origin, double count,
                                           float mean_depth) const {
  const double d = distance(toVector(plane), origin);
  const double allowed_sum = count * allowedError(mean_depth);
  const bool noise_scaled = options_.acceptance == AcceptanceRule::kNoiseScaled;
  TileFit fit;
  fit.plane = toVector(plane);
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

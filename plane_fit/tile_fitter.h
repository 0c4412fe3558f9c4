// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "planecloud_slam/plane_fit/moment_pyramid.h"
#include "planecloud_slam/plane_fit/quadtree_fitter_options.h"

namespace planecloud {

/// A plane of inverse depth in the tangents about the centre of the node's initial tile,
/// and how well it fits.
struct TileFit {
  Eigen::Vector3f plane = Eigen::Vector3f::Zero();  ///< alpha, beta, gamma [1/m]
  double count = 0.0;                               ///< pixels with depth
  double depth_sum = 0.0;                           ///< sum of |z - z^| [m]
  double point_plane_sum = 0.0;                     ///< sum of distances to the plane [m]
};

/// Decides on one node of Algorithm 1: depth at the corners, planarity, regression, error.
class TileFitter {
 public:
  /// The rule by which a pyramid weighs residuals as these options do.
  [[nodiscard]] static DistortionRule distortionRule(const QuadtreeFitterOptions& options);

  /// Keeps a reference to `pyramid`, which weighs by `distortionRule(options)`.
  TileFitter(const MomentPyramid& pyramid, const QuadtreeFitterOptions& options)
      : pyramid_(pyramid), options_(options) {}

  /// The node's plane; empty when the node has to be subdivided.
  [[nodiscard]] std::optional<TileFit> fit(const QuadtreeNode& node) const;
  /// The node's plane and its error along the rays, without a look at the pixels; for a node with
  /// depth. The moments know the mean square of the residuals, and noise has a mean of 0.8 of its
  /// root.
  [[nodiscard]] TileFit estimate(const QuadtreeNode& node) const;
  /// `point_plane_sum` of an estimate [m].
  [[nodiscard]] double estimatePointPlane(const QuadtreeNode& node, const TileFit& fit) const;
  /// The error of that plane from some of its pixels.
  [[nodiscard]] TileFit sample(const QuadtreeNode& node, const Eigen::Vector3f& plane) const;
  /// The node has enough pixels with depth, its corners among them.
  [[nodiscard]] bool isSupported(const QuadtreeNode& node) const {
    return pyramid_.isFull(node) || hasEnoughDepth(node);
  }
  /// The estimated error that acceptance asks about (along the ray, or only to the plane without
  /// `along_ray_test`), summed over the node's pixels and in units of the tolerance. Negative when
  /// the node cannot be a tile: too little depth, or a plane that is not in front of the camera.
  [[nodiscard]] float distortion(const QuadtreeNode& node) const {
    if (!isSupported(node)) return -1.0F;
    const float known = pyramid_.distortion(node);
    return known < 0.0F || !options_.along_ray_test ? distortionByPlane(node) : known;
  }

 private:
  [[nodiscard]] float distortionByPlane(const QuadtreeNode& node) const;
  [[nodiscard]] bool hasEnoughDepth(const QuadtreeNode& node) const;
  /// A pixel with depth: tangents about the tile's origin, inverse depth.
  struct Corner {
    float u = 0.0F;
    float v = 0.0F;
    float q = 0.0F;
  };
  // Upper left, upper right, lower left, lower right.
  using Corners = std::array<Corner, 4>;
  using CornerPixels = std::array<Eigen::Vector2i, 4>;

  /// Pixels along both sides of a corner that `CornerCheck` looks at.
  [[nodiscard]] int cornerWindow(const TileRect& rect) const;
  [[nodiscard]] bool hasDepthAtCorners(const QuadtreeNode& node) const;
  /// Pixels with depth near the corners; empty where one has none.
  [[nodiscard]] std::optional<CornerPixels> findCorners(const TileRect& rect) const;
  [[nodiscard]] std::optional<Eigen::Vector2i> nearestDepth(const Eigen::Vector2i& corner,
                                                            const Eigen::Vector2i& inwards,
                                                            int window) const;
  [[nodiscard]] Corners cornersAt(const CornerPixels& pixels) const;
  [[nodiscard]] bool isPlanar(const Corners& corners, const Eigen::Vector2f& origin,
                              float allowed) const;
  [[nodiscard]] bool isInFront(const QuadtreeNode& node, const NodePlane& plane) const;
  [[nodiscard]] std::optional<TileFit> measure(const TileRect& rect, const NodePlane& plane,
                                               const Eigen::Vector2f& origin, double count,
                                               float mean_depth) const;
  [[nodiscard]] float allowedError(float depth) const;
  /// Distance of a node's plane from the origin [m].
  [[nodiscard]] float planeDistance(const QuadtreeNode& node, const Eigen::Vector3f& plane) const;

  const MomentPyramid& pyramid_;
  QuadtreeFitterOptions options_;
};

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "planecloud_slam/plane_fit/camera.h"

namespace planecloud {

/// A rectangle of pixels: columns [x, x + width), rows [y, y + height).
struct TileRect {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;
  [[nodiscard]] int area() const { return width * height; }
  friend bool operator==(const TileRect& a, const TileRect& b) {
    return a.x == b.x && a.y == b.y && a.width == b.width && a.height == b.height;
  }
};

/// A planar patch seen through a rectangle of pixels. On a plane, inverse depth is linear in the
/// tangents: `q = alpha u + beta v + gamma` [1/m] (paper eq. (3), divided by -d).
struct PlanarTile {
  TileRect rect;
  Eigen::Vector3f inverse_depth = Eigen::Vector3f::Zero();  ///< alpha, beta, gamma [1/m]

  /// Depth along the optical axis [m] at tangents (u, v); only meaningful where q > 0.
  [[nodiscard]] float depthAt(float u, float v) const {
    return 1.0F / (inverse_depth.x() * u + inverse_depth.y() * v + inverse_depth.z());
  }
  /// Hessian normal form (a b c d) in the optical frame, `a x + b y + c z + d = 0`, (a b c) unit,
  /// pointing at the camera (d > 0) [-, m].
  [[nodiscard]] Eigen::Vector4d plane() const;
};

/// How an image is cut into tiles: a grid of initial tiles, each the root of a quadtree whose nodes
/// split ceil / floor in both directions until `min_tile`; border tiles are clipped.
struct QuadtreeLayout {
  int initial_width = 64;   ///< [px], [2, 80]
  int initial_height = 64;  ///< [px], [2, 60] or up to 64
  int min_tile = 4;         ///< smallest tile side [px], [2, initial]
  friend bool operator==(const QuadtreeLayout& a, const QuadtreeLayout& b) {
    return a.initial_width == b.initial_width && a.initial_height == b.initial_height &&
           a.min_tile == b.min_tile;
  }
};

/// What the fit knows of its own quality. Errors are means over the covered valid pixels.
struct PlaneCloudStatistics {
  // Errors of pruned clouds follow from the moments, corrected by a look at the pixels of some
  // tiles where time allows.
  double coverage = 0.0;           ///< covered share of the pixels with depth, [0, 1]
  double point_plane_error = 0.0;  ///< mean distance of points to their planes [m]
  double depth_error = 0.0;        ///< mean error along the viewing ray's depth [m]
  double fit_time = 0.0;           ///< [s]
  bool stopped_by_time = false;    ///< the time budget ended the fit
  bool stopped_by_bytes = false;   ///< the byte budget ended the fit
};

/// The planes of one depth image: tiles do not overlap and come in coding order.
struct PlaneCloud {
  CameraIntrinsics camera;
  QuadtreeLayout layout;
  std::vector<PlanarTile> tiles;
  PlaneCloudStatistics statistics;
  /// 1 where a pixel of the tiles had depth, else 0, height x width; empty: not known.
  Image<std::uint8_t> mask;
};

/// Wire formats of a plane cloud; the values are part of the wire contract.
enum class PlaneCloudEncoding : std::uint8_t {
  kRaw = 1,       ///< the paper's 8 float32 a plane: a b c d x y width height
  kCompact = 2,   ///< quadtree shape + quantised, range-coded inverse-depth coefficients
  kLossless = 3,  ///< the depth image itself, range-coded; planes are fitted by the receiver
};

[[nodiscard]] std::string toString(PlaneCloudEncoding encoding);
void fromString(const std::string& text, PlaneCloudEncoding& encoding);

/// A serialised plane cloud as it travels in a keyframe.
struct EncodedPlaneCloud {
  CameraIntrinsics camera;
  PlaneCloudEncoding encoding = PlaneCloudEncoding::kCompact;
  std::uint32_t plane_count = 0;
  std::vector<std::uint8_t> bytes;  ///< self-contained stream, version first
  PlaneCloudStatistics statistics;
};

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

namespace planecloud {

/// Row-major float planes of one image with padded rows: every row may be read 16 floats past its
/// end. Tangents (u, v) are about the centre of the initial tile they lie in.
struct TangentRows {
  const float* u = nullptr;
  const float* v = nullptr;
  std::ptrdiff_t stride = 0;  ///< [floats], of the inverse depth as well
};

/// Sums of the tangents over some pixels of a node.
struct TangentSums {
  float u = 0.0F, v = 0.0F, uu = 0.0F, uv = 0.0F, vv = 0.0F;

  TangentSums& operator+=(const TangentSums& other) {
    u += other.u;
    v += other.v;
    uu += other.uu;
    uv += other.uv;
    vv += other.vv;
    return *this;
  }
};

/// The pixels of a rectangle.
struct PixelBlock {
  const float* inverse_depth = nullptr;  ///< [1/m], 0: none
  TangentRows tangents;
  int width = 0;
  int rows = 0;
};

/// Sums over the rows of a strip for each pixel column.
struct ColumnSums {
  float* n = nullptr;
  float* q = nullptr;
  float* qu = nullptr;
  float* qv = nullptr;
  float* qq = nullptr;
};

/// A strip of the image, one row of cells high.
template <typename Pixel>
struct DepthStrip {
  const Pixel* depth = nullptr;
  std::ptrdiff_t depth_stride = 0;  ///< [pixels]
  TangentRows tangents;             ///< at the strip's first pixel
  float* inverse_depth = nullptr;   ///< written, 0: none; stride of `tangents`
  int width = 0;
  int rows = 0;
};

/// The data-dependent sums of one cell or node (paper eq. (4), bottom row).
struct alignas(16) DepthSums {
  float q = 0.0F;
  float qu = 0.0F;
  float qv = 0.0F;
  float qq = 0.0F;

  DepthSums& operator+=(const DepthSums& other) {
    q += other.q;
    qu += other.qu;
    qv += other.qv;
    qq += other.qq;
    return *this;
  }
};

/// Planes are only kept where their inverse depth is at least this inside the tile [1/m]: 64 m.
inline constexpr float kMinPlaneInverseDepth = 1.0F / 64.0F;

/// What the regression of nodes that have no holes takes from the camera, an array for each.
struct FullNodeRows {
  const float* inverse_n = nullptr;  ///< 1 / pixels, 0: no pixels
  const float* mean_u = nullptr;
  const float* mean_v = nullptr;
  const float* reach_u = nullptr;  ///< no pixel's u is farther from the mean
  const float* reach_v = nullptr;
  const float* inverse_uu = nullptr;  ///< of the centred scatter of (u, v)
  const float* inverse_uv = nullptr;
  const float* inverse_vv = nullptr;
};

/// A node's regression q = alpha u + beta v + gamma [1/m].
struct alignas(16) NodePlane {
  float alpha = 0.0F;
  float beta = 0.0F;
  float gamma = 0.0F;
  /// Root mean square of the residuals [1/m], with a minus where the plane may be farther inside
  /// the node than `kMinPlaneInverseDepth` allows.
  float rms = 0.0F;
};

/// Nodes of one level: pixels, pixels with depth, sums over them and regression.
struct NodeRows {
  const float* full = nullptr;
  const float* counts = nullptr;
  const DepthSums* sums = nullptr;
  const NodePlane* planes = nullptr;
};

/// How the residuals of a node's regression weigh: the sum over its pixels of factor * rms *
/// z^power, z its mean depth.
struct DistortionRule {
  float factor = 0.0F;
  int depth_power = 0;  ///< 0, 1 or 2
};

/// A plane q = alpha u + beta v + gamma against the pixels of a rectangle.
struct ResidualQuery {
  PixelBlock pixels;
  float alpha = 0.0F;
  float beta = 0.0F;
  float gamma = 0.0F;
};

/// Sums over the pixels with depth; q^ is the plane's inverse depth, z^ = 1 / q^.
struct ResidualSums {
  float inverse_depth = 0.0F;  ///< |q - q^| [1/m]
  float relative = 0.0F;       ///< |q - q^| z: times the plane's d = distance to the plane
  float depth = 0.0F;          ///< |z - z^| [m]
};

/// The loops over pixels. Two implementations that agree up to the order of summation.
struct TileKernels {
  const char* name;
  void (*sum_columns_f32)(const DepthStrip<float>& strip, const ColumnSums& sums);
  void (*sum_columns_u16)(const DepthStrip<std::uint16_t>& strip, const ColumnSums& sums);
  /// Adds up groups of `cell_width` columns: `cells` sums and counts.
  void (*sum_cells)(const ColumnSums& columns, int cell_width, int cells, DepthSums* sums,
                    float* counts);
  /// Over the pixels with depth.
  TangentSums (*sum_tangents)(const PixelBlock& pixels);
  /// Regression of `count` nodes as if they had no holes.
  void (*regress)(const DepthSums* sums, const FullNodeRows& nodes, std::size_t count,
                  NodePlane* planes);
  /// Distortion of `count` nodes that have depth in every pixel and a plane that is in front;
  /// negative for the others.
  void (*weigh)(const NodeRows& nodes, const DistortionRule& rule, std::size_t count,
                float* distortions);
  ResidualSums (*residuals)(const ResidualQuery& query);
};

/// Plain C++: the reference of the tests and the fallback.
[[nodiscard]] const TileKernels& scalarTileKernels();
/// The best this processor has, chosen at run time; the scalar ones when built without Highway.
[[nodiscard]] const TileKernels& vectorTileKernels();

}  // namespace planecloud

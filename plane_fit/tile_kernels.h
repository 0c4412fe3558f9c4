// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace planecloud {

/// Row-major float planes of one image. Tangents (u, v) are about the centre of the initial tile
/// they lie in.
struct TangentRows {
  const float* u = nullptr;
  const float* v = nullptr;
  std::ptrdiff_t stride = 0;  ///< [floats]
};

/// Sums of the tangents over some pixels of a node (paper eq. (4), the rows above the last).
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

/// Depth of a rectangle of pixels, as it comes in a message (see DepthTraits).
template <typename Pixel>
struct DepthBlock {
  const Pixel* depth = nullptr;
  std::ptrdiff_t stride = 0;  ///< [pixels]
  int width = 0;
  int rows = 0;
};

/// Sums over the rows of a strip for each pixel column.
struct ColumnSums {
  float* n = nullptr;
  float* q = nullptr;   ///< inverse depth [1/m]
  float* qy = nullptr;  ///< times the row, counted from the strip's first
  float* qq = nullptr;

  /// The columns from `first` on.
  [[nodiscard]] ColumnSums from(int first) const {
    return {n + first, q + first, qy + first, qq + first};
  }
};

/// Tangents of the pixels about one: u + right x + down y. Over a few pixels a lens is as good as
/// affine.
struct LocalTangents {
  float u = 0.0F, u_right = 0.0F, u_down = 0.0F;
  float v = 0.0F, v_right = 0.0F, v_down = 0.0F;

  /// The same about the pixel (x, y) from here.
  [[nodiscard]] LocalTangents about(int x, int y) const {
    const auto right = static_cast<float>(x);
    const auto down = static_cast<float>(y);
    return {u + right * u_right + down * u_down, u_right, u_down,
            v + right * v_right + down * v_down, v_right, v_down};
  }
};

/// `LocalTangents` of each of a row of cells, about its first pixel.
struct CellTangents {
  const float* u = nullptr;
  const float* u_right = nullptr;
  const float* u_down = nullptr;
  const float* v = nullptr;
  const float* v_right = nullptr;
  const float* v_down = nullptr;
};

/// A row of cells over a strip's columns.
struct CellRow {
  const int* edges = nullptr;  ///< first column of each cell, at last the end
  int cells = 0;
  int alike = 0;  ///< so many of them, from the first on, are as wide as the first
  int height = 0;
  CellTangents tangents;
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

/// How much of a node has depth.
enum class Fill : std::uint8_t { kNothing, kPart, kAll };

/// Of `count` pixels with depth among `area`.
[[nodiscard]] inline Fill fillOf(float count, float area) {
  return count == 0.0F ? Fill::kNothing : count == area ? Fill::kAll : Fill::kPart;
}

/// Sums of a row of cells, an array for each.
struct CellSums {
  DepthSums* depth = nullptr;
  float* counts = nullptr;
  Fill* fills = nullptr;
  float* distortions = nullptr;
};

/// Planes are only kept where their inverse depth is at least this inside the tile [1/m]: 64 m.
inline constexpr float kMinPlaneInverseDepth = 1.0F / 64.0F;

/// What the regression of nodes that have no holes takes from the camera, an array for each.
struct FullNodeRows {
  const float* n = nullptr;          ///< pixels
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

/// Regressions and how they weigh, an array for each.
struct PlaneFits {
  NodePlane* planes = nullptr;
  float* distortions = nullptr;
};

/// Moments of nodes about their origins, an array for each (see TileMoments).
struct MomentRows {
  const double *n, *u, *v, *uu, *uv, *vv, *q, *qu, *qv, *qq;
};

/// Regressions (see NodePlane; `rms` without a sign), an array for each.
struct PlaneRows {
  double *alpha, *beta, *gamma, *rms;
};

/// Sums over the pixels of a node that have depth: columns x and rows y, counted from its first.
struct PositionSums {
  float n = 0.0F, x = 0.0F, y = 0.0F, xx = 0.0F, xy = 0.0F, yy = 0.0F;
  /// Bit 2 r + c of a quarter that has depth: in the upper (r = 0) or lower, left (c = 0) or right
  /// half; odd sides have their larger half first.
  std::uint8_t quarters = 0;
};

/// How the residuals of a node's regression weigh: the sum over its pixels of factor * rms *
/// z^power, z its mean depth.
struct DistortionRule {
  float factor = 0.0F;
  int depth_power = 0;  ///< 0, 1 or 2

  /// Of `n` pixels whose inverse depth sums up to `q` and leaves `rms`.
  [[nodiscard]] float weigh(float n, float q, float rms) const {
    float scale = factor * n;
    for (int power = 0; power < depth_power; ++power) scale *= n / q;
    return scale * rms;
  }
};

/// What the pixels of a block that have depth add to a node's moments.
struct BlockSums {
  TangentSums tangents;
  float qu = 0.0F;
  float qv = 0.0F;

  BlockSums& operator+=(const BlockSums& other) {
    tangents += other.tangents;
    qu += other.qu;
    qv += other.qv;
    return *this;
  }
};

/// Sums over the pixels with depth; q^ is the plane's inverse depth, z^ = 1 / q^.
struct ResidualSums {
  float inverse_depth = 0.0F;  ///< |q - q^| [1/m]
  float relative = 0.0F;       ///< |q - q^| z: times the plane's d = distance to the plane
  float depth = 0.0F;          ///< |z - z^| [m]

  ResidualSums& operator+=(const ResidualSums& other) {
    inverse_depth += other.inverse_depth;
    relative += other.relative;
    depth += other.depth;
    return *this;
  }
};

/// The loops over pixels. `tangents` begin at the block's first pixel.
template <typename Pixel>
struct PixelKernels {
  void (*sum_columns)(const DepthBlock<Pixel>& strip, const ColumnSums& sums);
  PositionSums (*sum_positions)(const DepthBlock<Pixel>& block);
  BlockSums (*sum_block)(const DepthBlock<Pixel>& block, const TangentRows& tangents);
  /// Of the plane q = alpha u + beta v + gamma.
  ResidualSums (*residuals)(const DepthBlock<Pixel>& block, const TangentRows& tangents,
                            const NodePlane& plane);
};

/// The loops of the fit. Two implementations that agree up to the order of summation.
struct TileKernels {
  const char* name;
  PixelKernels<float> f32;
  PixelKernels<std::uint16_t> u16;
  /// Adds up the columns of each cell, and weighs what a regression would leave of it if it has no
  /// holes (see `regress`): in pixels, where regression needs nothing of the camera.
  void (*sum_cells)(const ColumnSums& columns, const CellRow& row, const DistortionRule& rule,
                    const CellSums& sums);
  /// Regression of `count` nodes as if they had no holes, and its distortion; negative where the
  /// plane may be too far off (see `NodePlane`).
  void (*regress)(const DepthSums* sums, const FullNodeRows& nodes, const DistortionRule& rule,
                  std::size_t count, const PlaneFits& fits);
  /// Regression of `count` nodes with n > 0, holes or not.
  void (*regress_moments)(const MomentRows& moments, const PlaneRows& planes, std::size_t count);

  template <typename Pixel>
  [[nodiscard]] const PixelKernels<Pixel>& of() const {
    if constexpr (std::is_same_v<Pixel, float>) {
      return f32;
    } else {
      return u16;
    }
  }
};

/// Plain C++: the reference of the tests and the fallback.
[[nodiscard]] const TileKernels& scalarTileKernels();
/// The best this processor has, chosen at run time; the scalar ones when built without Highway.
[[nodiscard]] const TileKernels& vectorTileKernels();

}  // namespace planecloud

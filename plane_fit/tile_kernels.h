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

/// A plane q = alpha u + beta v + gamma against the pixels of a rectangle.
struct ResidualQuery {
  const float* inverse_depth = nullptr;
  TangentRows tangents;
  int width = 0;
  int rows = 0;
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
  ResidualSums (*residuals)(const ResidualQuery& query);
};

/// Plain C++: the reference of the tests and the fallback.
[[nodiscard]] const TileKernels& scalarTileKernels();
/// The best this processor has, chosen at run time; the scalar ones when built without Highway.
[[nodiscard]] const TileKernels& vectorTileKernels();

}  // namespace planecloud

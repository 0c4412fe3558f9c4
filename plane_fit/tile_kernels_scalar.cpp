// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/plane_fit/tile_kernels_scalar.h"

namespace planecloud {
namespace {

template <typename Pixel>
PixelKernels<Pixel> pixelKernels() {
  return {
      [](const DepthBlock<Pixel>& strip, const ColumnSums& sums) {
        scalar::sumColumns(strip, sums, 0);
      },
      &scalar::sumPositions<Pixel>,
      [](const DepthBlock<Pixel>& block, const TangentRows& tangents) {
        return scalar::sumBlock(block, tangents, 0);
      },
      [](const DepthBlock<Pixel>& block, const TangentRows& tangents, const NodePlane& plane) {
        return scalar::residuals(block, tangents, plane, 0);
      },
  };
}

}  // namespace

const TileKernels& scalarTileKernels() {
  static const TileKernels kernels{
      "scalar",
      pixelKernels<float>(),
      pixelKernels<std::uint16_t>(),
      [](const ColumnSums& columns, const CellRow& row, const DistortionRule& rule,
         const CellSums& sums) { scalar::sumCells(columns, row, rule, 0, sums); },
      [](const DepthSums* sums, const FullNodeRows& nodes, const DistortionRule& rule,
         std::size_t count,
         const PlaneFits& fits) { scalar::regress(sums, nodes, rule, 0, count, fits); },
      [](const MomentRows& moments, const PlaneRows& planes, std::size_t count) {
        scalar::regressMoments(moments, planes, 0, count);
      },
  };
  return kernels;
}

#ifndef PLANECLOUD_SLAM_HAVE_HIGHWAY
const TileKernels& vectorTileKernels() { return scalarTileKernels(); }
#endif

}  // namespace planecloud

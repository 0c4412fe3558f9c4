// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/plane_fit/tile_kernels_scalar.h"

namespace planecloud {

const TileKernels& scalarTileKernels() {
  static const TileKernels kernels{
      "scalar",
      [](const DepthStrip<float>& strip, const ColumnSums& sums) {
        scalar::sumColumns(strip, sums, 0);
      },
      [](const DepthStrip<std::uint16_t>& strip, const ColumnSums& sums) {
        scalar::sumColumns(strip, sums, 0);
      },
      [](const ColumnSums& columns, int cell_width, int cells, DepthSums* sums, float* counts) {
        scalar::sumCells(columns, cell_width, 0, cells, sums, counts);
      },
      &scalar::sumTangents,
      [](const DepthSums* sums, const FullNodeRows& nodes, std::size_t count, NodePlane* planes) {
        scalar::regress(sums, nodes, 0, count, planes);
      },
      [](const NodeRows& nodes, const DistortionRule& rule, std::size_t count, float* distortions) {
        scalar::weigh(nodes, rule, 0, count, distortions);
      },
      &scalar::residuals,
  };
  return kernels;
}

#ifndef PLANECLOUD_SLAM_HAVE_HIGHWAY
const TileKernels& vectorTileKernels() { return scalarTileKernels(); }
#endif

}  // namespace planecloud

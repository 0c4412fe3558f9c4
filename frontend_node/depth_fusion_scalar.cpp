// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/frontend_node/depth_fusion_scalar.h"

namespace planecloud {

const FusionKernels& scalarFusionKernels() {
  static const FusionKernels kernels{
      "scalar",
      [](const FusionWarp& warp, const FusionRow& row, ImageView<float> depth, float* mean,
         std::uint8_t* observations) { scalar::improve(warp, row, depth, mean, observations, 0); },
      [](const FusionWarp& warp, const FusionRow& row, const float* depth, int* at,
         float* inverse_depth) { scalar::project(warp, row, depth, at, inverse_depth, 0); },
  };
  return kernels;
}

#ifndef PLANECLOUD_SLAM_HAVE_HIGHWAY
const FusionKernels& vectorFusionKernels() { return scalarFusionKernels(); }
#endif

}  // namespace planecloud

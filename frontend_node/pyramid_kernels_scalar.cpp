// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/frontend_node/pyramid_kernels_scalar.h"

namespace planecloud {

const PyramidKernels& scalarPyramidKernels() {
  static const PyramidKernels kernels{
      "scalar",
      [](const GreyRows& rows, int count, float* made) { scalar::halveGrey(rows, 0, count, made); },
      [](const DepthRows& rows, const DepthRange& range, int count, GreyDepth* made) {
        scalar::halveDepth(rows, range, 0, count, made);
      },
      [](const GreyDepth* upper, const GreyDepth* lower, int count, GreyDepth* made) {
        scalar::halveLevel(upper, lower, 0, count, made);
      },
  };
  return kernels;
}

#ifndef PLANECLOUD_SLAM_HAVE_HIGHWAY
const PyramidKernels& vectorPyramidKernels() { return scalarPyramidKernels(); }
#endif

}  // namespace planecloud

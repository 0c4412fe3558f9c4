// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/frontend_node/half_remap_kernel_scalar.h"

namespace planecloud {

HalfRemapKernel scalarHalfRemap() {
  return [](const GreySource& source, const HalfRemapRow& row, std::size_t count, float* grey) {
    scalar::halfRemap(source, row, 0, count, grey);
  };
}

#ifndef PLANECLOUD_SLAM_HAVE_HIGHWAY
HalfRemapKernel vectorHalfRemap() { return scalarHalfRemap(); }
#endif

}  // namespace planecloud

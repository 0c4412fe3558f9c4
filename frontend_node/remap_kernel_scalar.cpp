// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/frontend_node/remap_kernel_scalar.h"

namespace planecloud {

RemapKernel scalarRemap() {
  return [](const RemapSource& source, const RemapRow& row, std::size_t count, std::uint8_t* grey,
            float* depth) { scalar::remap(source, row, 0, count, grey, depth); };
}

#ifndef PLANECLOUD_SLAM_HAVE_HIGHWAY
RemapKernel vectorRemap() { return scalarRemap(); }
#endif

}  // namespace planecloud

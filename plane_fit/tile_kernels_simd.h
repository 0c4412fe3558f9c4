// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "planecloud_slam/plane_fit/tile_kernels.h"

namespace planecloud {

/// Those over pixels, for the instruction set that Highway has chosen.
void addVectorPixelKernels(TileKernels& kernels);

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "planecloud_slam/frontend_node/alignment_kernel.h"

namespace planecloud {

/// Adds `sum` and `sum_blocks` for the instruction set that Highway has chosen.
void addVectorSums(AlignmentKernels& kernels);

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "planecloud_slam/frontend_node/alignment_kernel.h"

namespace planecloud {

/// See `AlignmentKernels::sum`.
using SumKernel = void (*)(const ReferencePoints&, const ResidualView&, const Whitening&,
                           NormalEquations&);

/// The sum for the best instruction set this processor has.
[[nodiscard]] SumKernel vectorSum();

}  // namespace planecloud

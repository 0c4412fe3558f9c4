// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

namespace planecloud {

/// Symmetric: `agrees[i][j]` says whether members i and j are consistent.
using ConsistencyMatrix = std::vector<std::vector<bool>>;

/// A largest set of members of which every two agree, as far as a greedy search from each member
/// finds it (the exact clique problem is exponential). Ascending; the first one found wins ties.
[[nodiscard]] std::vector<std::size_t> largestConsistentGroup(const ConsistencyMatrix& agrees);

}  // namespace planecloud

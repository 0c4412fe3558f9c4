// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/backend_node/consistent_group.h"

#include <algorithm>
#include <numeric>

namespace planecloud {

std::vector<std::size_t> largestConsistentGroup(const ConsistencyMatrix& agrees) {
  const std::size_t size = agrees.size();
  std::vector<std::size_t> by_degree(size);
  std::iota(by_degree.begin(), by_degree.end(), std::size_t{0});
  const auto degree = [&](std::size_t i) {
    return std::count(agrees[i].begin(), agrees[i].end(), true);
  };
  std::stable_sort(by_degree.begin(), by_degree.end(),
                   [&](std::size_t a, std::size_t b) { return degree(a) > degree(b); });
  std::vector<std::size_t> best;
  for (std::size_t seed = 0; seed < size; ++seed) {
    std::vector<std::size_t> group{seed};
    for (const std::size_t member : by_degree) {
      if (member == seed) continue;
      const bool fits = std::all_of(group.begin(), group.end(),
                                    [&](std::size_t other) { return agrees[member][other]; });
      if (fits) group.push_back(member);
    }
    if (group.size() > best.size()) best = group;
  }
  std::sort(best.begin(), best.end());
  return best;
}

}  // namespace planecloud

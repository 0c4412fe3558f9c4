// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "planecloud_slam/plane_fit/plane_regression.h"
#include "planecloud_slam/plane_fit/tile_kernels.h"

namespace planecloud {

/// The nodes of one level that have holes, to be regressed at once: which they are, their moments
/// and then their planes. Keeps its memory.
class MomentList {
 public:
  void clear() { nodes_.clear(); }
  void add(std::size_t node, const TileMoments& moments) {
    const std::size_t i = nodes_.size();
    nodes_.push_back(node);
    if (values_[0].size() <= i) {
      for (std::vector<double>& values : values_) values.resize(2 * i + 64);
    }
    const std::array<double, kMoments> sums = {moments.n,  moments.u,  moments.v, moments.uu,
                                               moments.uv, moments.vv, moments.q, moments.qu,
                                               moments.qv, moments.qq};
    for (std::size_t j = 0; j < kMoments; ++j) values_[j][i] = sums[j];
  }

  [[nodiscard]] std::size_t size() const { return nodes_.size(); }
  /// Index of the node on its level.
  [[nodiscard]] std::size_t node(std::size_t i) const { return nodes_[i]; }

  void regress(const TileKernels& kernels) {
    const auto row = [&](std::size_t j) { return values_[j].data(); };
    kernels.regress_moments(
        {row(0), row(1), row(2), row(3), row(4), row(5), row(6), row(7), row(8), row(9)},
        {row(10), row(11), row(12), row(13)}, size());
  }
  /// After `regress`.
  [[nodiscard]] NodePlane plane(std::size_t i) const {
    return {static_cast<float>(values_[10][i]), static_cast<float>(values_[11][i]),
            static_cast<float>(values_[12][i]), static_cast<float>(values_[13][i])};
  }

 private:
  static constexpr std::size_t kMoments = 10;

  std::vector<std::size_t> nodes_;
  std::array<std::vector<double>, kMoments + 4> values_;
};

}  // namespace planecloud

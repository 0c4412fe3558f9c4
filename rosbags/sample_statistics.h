// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

namespace planecloud {

/// Figures of a list of numbers; all NaN when it is empty.
struct SampleStatistics {
  std::size_t count = 0;
  double total = 0.0;
  double mean = 0.0;
  double deviation = 0.0;  ///< standard deviation of the population
  double min = 0.0;
  double max = 0.0;
  double median = 0.0;
  double p95 = 0.0;  ///< 95th percentile, interpolated
};

[[nodiscard]] SampleStatistics summarise(std::vector<double> samples);

}  // namespace planecloud

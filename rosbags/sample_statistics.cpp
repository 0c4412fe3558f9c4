// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/rosbags/sample_statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace planecloud {
namespace {

/// `share` in [0, 1] of the way through `sorted`, linear between neighbours.
double quantile(const std::vector<double>& sorted, double share) {
  const double position = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(position);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  const double rest = position - static_cast<double>(below);
  return (1.0 - rest) * sorted[below] + rest * sorted[above];
}

}  // namespace

SampleStatistics summarise(std::vector<double> samples) {
  SampleStatistics result;
  if (samples.empty()) {
    result.mean = result.deviation = result.min = result.max = result.median = result.p95 =
        std::numeric_limits<double>::quiet_NaN();
    return result;
  }
  std::sort(samples.begin(), samples.end());
  const auto count = static_cast<double>(samples.size());
  result.count = samples.size();
  result.total = std::accumulate(samples.begin(), samples.end(), 0.0);
  result.mean = result.total / count;
  double squares = 0.0;
  for (const double sample : samples) squares += (sample - result.mean) * (sample - result.mean);
  result.deviation = std::sqrt(squares / count);
  result.min = samples.front();
  result.max = samples.back();
  result.median = quantile(samples, 0.5);
  result.p95 = quantile(samples, 0.95);
  return result;
}

}  // namespace planecloud

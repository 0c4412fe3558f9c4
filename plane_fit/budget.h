// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <optional>
#include <utility>

namespace planecloud {

/// What one fit may cost (paper sec. 3.3: "until either the bandwidth or computational time
/// constraints are exceeded or all tiles have been processed"). Default: no limit.
struct FitBudget {
  using Clock = std::chrono::steady_clock;

  /// The fit stops soon after this instant; needs `now`.
  std::optional<Clock::time_point> deadline;
  /// The clock, normally `&FitBudget::Clock::now`. Without it `fit_time` is not measured.
  std::function<Clock::time_point()> now;
  /// The fit stops before its planes need more than this [B], counted at `bytes_per_plane`.
  std::optional<std::size_t> bytes;
  /// Cost of one plane [B]: 8 float32 (paper sec. 4) unless the caller knows its coder better.
  double bytes_per_plane = 32.0;

  /// A budget that ends `seconds` after `now()`; 0: no limit, but the time is measured.
  [[nodiscard]] static FitBudget fromNow(double seconds, std::function<Clock::time_point()> now) {
    FitBudget budget;
    if (seconds > 0.0) {
      const std::chrono::duration<double> length(seconds);
      budget.deadline = now() + std::chrono::duration_cast<Clock::duration>(length);
    }
    budget.now = std::move(now);
    return budget;
  }
};

}  // namespace planecloud

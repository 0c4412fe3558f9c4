// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>

#include "planecloud_slam/frontend_node/frontend.h"
#include "planecloud_slam/plane_fit/budget.h"
#include "planecloud_slam/plane_fit/keyframe.h"

namespace planecloud {

/// The fitting half of the frontend: turns a completed keyframe into what travels (plane cloud
/// under time and byte budgets, appearance descriptor). One per thread.
class KeyframeCompressor {
 public:
  /// Throws std::invalid_argument when `options` fail their check.
  explicit KeyframeCompressor(const FrontendOptions& options);
  ~KeyframeCompressor();
  KeyframeCompressor(KeyframeCompressor&&) noexcept;
  KeyframeCompressor& operator=(KeyframeCompressor&&) noexcept;

  /// Fits, encodes and describes. `now` is the clock of `plane_fit/time_budget` (normally
  /// `&FitBudget::Clock::now`); without it there is no time budget and the result depends on the
  /// keyframe alone.
  [[nodiscard]] Keyframe compress(CompletedKeyframe completed,
                                  std::function<FitBudget::Clock::time_point()> now = {});

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>

#include "planecloud_slam/frontend_node/frontend.h"
#include "planecloud_slam/plane_fit/budget.h"
#include "planecloud_slam/plane_fit/keyframe.h"

namespace planecloud {

/// What one keyframe may cost at the moment.
struct KeyframeBudget {
  /// Clock of `plane_fit/time_budget`, normally `&FitBudget::Clock::now`; without it there is no
  /// time budget and the result depends on the keyframe alone.
  std::function<FitBudget::Clock::time_point()> now;
  /// Most bytes of planes and texture, beside `codec/byte_budget`; none: no such limit.
  std::optional<std::size_t> bytes;
};

/// The fitting half of the frontend: turns a completed keyframe into what travels (plane cloud and
/// texture under time and byte budgets, edges to the short-term history, appearance descriptor).
/// One per thread.
class KeyframeCompressor {
 public:
  /// Throws std::invalid_argument when `options` fail their check.
  explicit KeyframeCompressor(const FrontendOptions& options);
  ~KeyframeCompressor();
  KeyframeCompressor(KeyframeCompressor&&) noexcept;
  KeyframeCompressor& operator=(KeyframeCompressor&&) noexcept;

  /// Fits, encodes, aligns with the history and describes.
  [[nodiscard]] Keyframe compress(CompletedKeyframe completed, const KeyframeBudget& budget = {});

  /// Goes on with other options for the next keyframe. Throws, and changes nothing, when they fail
  /// their check.
  void setOptions(const FrontendOptions& options);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "planecloud_slam/frontend_node/frontend.h"
#include "planecloud_slam/plane_fit/keyframe.h"

namespace planecloud_slam {

/// The fitting half of the frontend: turns a completed keyframe into what travels (plane cloud
/// under time and byte budgets, appearance descriptor). One per thread.
class KeyframeCompressor {
 public:
  /// Throws std::invalid_argument when `options` fail their check.
  explicit KeyframeCompressor(const FrontendOptions& options);
  ~KeyframeCompressor();
  KeyframeCompressor(KeyframeCompressor&&) noexcept;
  KeyframeCompressor& operator=(KeyframeCompressor&&) noexcept;

  [[nodiscard]] Keyframe compress(CompletedKeyframe completed);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace planecloud_slam

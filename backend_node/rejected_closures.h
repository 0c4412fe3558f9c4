// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <deque>
#include <map>
#include <string>
#include <vector>

#include "planecloud_slam/backend_node/graph_edge.h"

namespace planecloud {

/// Two keyframes that were thought to show the same place and are not connected by a closure.
struct RejectedClosure {
  KeyframeId from;  ///< the older one
  KeyframeId to;
  std::string reason;  ///< snake-case word: a ClosureVerdict, or what befell it afterwards
};

/// What became of candidates that are no closures: how many for each reason, and the newest pairs.
class RejectedClosures {
 public:
  /// Pairs remembered; older ones are only counted.
  static constexpr std::size_t kRemembered = 1000;

  void add(RejectedClosure rejected);
  /// Verified closures that did not last.
  void add(const std::vector<GraphEdge>& closures, const std::string& reason);

  /// Of all, by reason.
  [[nodiscard]] const std::map<std::string, std::size_t>& counts() const { return counts_; }
  /// Oldest first.
  [[nodiscard]] const std::deque<RejectedClosure>& newest() const { return newest_; }

 private:
  std::map<std::string, std::size_t> counts_;
  std::deque<RejectedClosure> newest_;
};

}  // namespace planecloud

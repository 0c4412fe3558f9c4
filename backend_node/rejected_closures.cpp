// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/backend_node/rejected_closures.h"

#include <utility>

namespace planecloud {

void RejectedClosures::add(RejectedClosure rejected) {
  ++counts_[rejected.reason];
  newest_.push_back(std::move(rejected));
  if (newest_.size() > kRemembered) newest_.pop_front();
}

void RejectedClosures::add(const std::vector<GraphEdge>& closures, const std::string& reason) {
  for (const GraphEdge& closure : closures) add({closure.from, closure.to, reason});
}

}  // namespace planecloud

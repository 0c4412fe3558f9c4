// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/backend_node/plane_set_cache.h"

namespace planecloud {

PlaneSet PlaneSetCache::get(const KeyframeRecords& records, int node) {
  const auto found = by_node_.find(node);
  if (found != by_node_.end()) {
    entries_.splice(entries_.begin(), entries_, found->second);
    return entries_.front().second;
  }
  const PlaneCloud planes = *records.at(static_cast<std::size_t>(node)).keyframe->planes;
  entries_.emplace_front(node, PlaneSet(planes, options_));
  by_node_[node] = entries_.begin();
  if (entries_.size() > capacity_) {
    by_node_.erase(entries_.back().first);
    entries_.pop_back();
  }
  return entries_.front().second;
}

void PlaneSetCache::clear() {
  entries_.clear();
  by_node_.clear();
}

}  // namespace planecloud

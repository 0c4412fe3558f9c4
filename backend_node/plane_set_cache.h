// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <list>
#include <unordered_map>
#include <utility>

#include "planecloud_slam/backend_node/keyframe_record.h"
#include "planecloud_slam/icap/plane_set.h"

namespace planecloud {

/// Keyframes prepared for alignment. A prepared one takes some hundred kilobytes, so only those
/// used last are kept; the others are prepared again when they are wanted.
class PlaneSetCache {
 public:
  PlaneSetCache(const PlaneSetOptions& options, std::size_t capacity)
      : options_(options), capacity_(capacity) {}

  /// The plane set of keyframe `node`.
  [[nodiscard]] PlaneSet get(const KeyframeRecords& records, int node);

  void clear();

 private:
  using Entry = std::pair<int, PlaneSet>;

  PlaneSetOptions options_;
  std::size_t capacity_;
  std::list<Entry> entries_;  ///< most recently used first
  std::unordered_map<int, std::list<Entry>::iterator> by_node_;
};

}  // namespace planecloud

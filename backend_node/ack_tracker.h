// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "planecloud_slam/plane_fit/keyframe.h"

namespace planecloud {

/// What there is of one session of one robot, as it is acknowledged.
struct SessionReceipt {
  std::string robot;
  std::uint64_t session = 0;
  std::int64_t highest_without_gap = -1;  ///< -1: not even number 0
  std::int64_t highest = -1;              ///< -1: none
  std::vector<std::uint32_t> gaps;        ///< missing between the two, ascending
};

/// Remembers which keyframes arrived and which of them are settled: in the map, or refused for
/// good.
class AckTracker {
 public:
  /// Gaps beyond this many are told when these are filled.
  static constexpr std::size_t kMaxGaps = 256;

  /// A keyframe arrived and waits to be settled. False when it did before.
  bool noteArrival(const KeyframeId& id);
  /// The highest number that arrived of the session of `id`, settled or not; -1: none.
  [[nodiscard]] std::int64_t highestArrived(const KeyframeId& id) const;
  /// The keyframe need not come again.
  void settle(const KeyframeId& id);

  /// Receipts of all sessions that anything was settled of; counts only what is settled.
  [[nodiscard]] std::vector<SessionReceipt> receipts() const;
  /// How many keyframes are missing before others that are settled.
  [[nodiscard]] std::size_t missing() const;

 private:
  struct Session {
    std::set<std::uint32_t> waiting;
    std::set<std::uint32_t> settled;  ///< above `highest_without_gap`
    std::int64_t highest_without_gap = -1;
  };
  using Key = std::pair<std::string, std::uint64_t>;

  [[nodiscard]] static SessionReceipt receipt(const Key& key, const Session& session);

  std::map<Key, Session> sessions_;
};

}  // namespace planecloud

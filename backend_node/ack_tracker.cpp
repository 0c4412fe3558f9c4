// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/backend_node/ack_tracker.h"

#include <algorithm>

namespace planecloud {

bool AckTracker::noteArrival(const KeyframeId& id) {
  Session& session = sessions_[{id.robot, id.session}];
  if (std::int64_t{id.number} <= session.highest_without_gap) return false;
  if (session.settled.count(id.number) > 0) return false;
  return session.waiting.insert(id.number).second;
}

std::int64_t AckTracker::highestArrived(const KeyframeId& id) const {
  const auto found = sessions_.find({id.robot, id.session});
  if (found == sessions_.end()) return -1;
  const Session& session = found->second;
  std::int64_t highest = session.highest_without_gap;
  for (const std::set<std::uint32_t>* numbers : {&session.waiting, &session.settled}) {
    if (!numbers->empty()) highest = std::max(highest, std::int64_t{*numbers->rbegin()});
  }
  return highest;
}

void AckTracker::settle(const KeyframeId& id) {
  Session& session = sessions_[{id.robot, id.session}];
  session.waiting.erase(id.number);
  if (std::int64_t{id.number} > session.highest_without_gap) session.settled.insert(id.number);
  while (!session.settled.empty() &&
         std::int64_t{*session.settled.begin()} == session.highest_without_gap + 1) {
    session.settled.erase(session.settled.begin());
    ++session.highest_without_gap;
  }
}

SessionReceipt AckTracker::receipt(const Key& key, const Session& session) {
  SessionReceipt receipt;
  receipt.robot = key.first;
  receipt.session = key.second;
  receipt.highest = receipt.highest_without_gap = session.highest_without_gap;
  for (const std::uint32_t number : session.settled) {
    for (std::int64_t gap = receipt.highest + 1; gap < number; ++gap) {
      if (receipt.gaps.size() == kMaxGaps) {
        receipt.highest = gap - 1;
        return receipt;
      }
      receipt.gaps.push_back(static_cast<std::uint32_t>(gap));
    }
    receipt.highest = number;
  }
  return receipt;
}

std::vector<SessionReceipt> AckTracker::receipts() const {
  std::vector<SessionReceipt> receipts;
  for (const auto& [key, session] : sessions_) {
    SessionReceipt one = receipt(key, session);
    if (one.highest >= 0) receipts.push_back(std::move(one));
  }
  return receipts;
}

std::size_t AckTracker::missing() const {
  std::size_t count = 0;
  for (const auto& [key, session] : sessions_) {
    if (session.settled.empty()) continue;
    const std::int64_t span = std::int64_t{*session.settled.rbegin()} - session.highest_without_gap;
    count += static_cast<std::size_t>(span) - session.settled.size();
  }
  return count;
}

}  // namespace planecloud

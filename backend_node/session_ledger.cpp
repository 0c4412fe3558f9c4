// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/backend_node/session_ledger.h"

#include <algorithm>

namespace planecloud {

std::string SessionLedger::clash(const Keyframe& keyframe) const {
  const KeyframeId& id = keyframe.id;
  const auto robot = sessions_.find(id.robot);
  if (robot == sessions_.end()) return "";
  const auto own = robot->second.find(id.session);
  // A gap that is filled late is no sign of life.
  if (own != robot->second.end() && id.number <= own->second.last_number) return "";
  for (auto newer = robot->second.upper_bound(id.session); newer != robot->second.end(); ++newer) {
    if (keyframe.stamp <= newer->second.first_stamp) continue;
    return "keyframe " + toString(id) + " refused: two running frontends call themselves \"" +
           id.robot + "\", sessions " + std::to_string(id.session) + " and " +
           std::to_string(newer->first) + "; give each robot its own name";
  }
  return "";
}

void SessionLedger::record(const Keyframe& keyframe) {
  std::map<std::uint64_t, Session>& sessions = sessions_[keyframe.id.robot];
  const auto [session, is_new] =
      sessions.try_emplace(keyframe.id.session, Session{keyframe.stamp, keyframe.id.number});
  if (is_new) return;
  session->second.first_stamp = std::min(session->second.first_stamp, keyframe.stamp);
  session->second.last_number = std::max(session->second.last_number, keyframe.id.number);
}

}  // namespace planecloud

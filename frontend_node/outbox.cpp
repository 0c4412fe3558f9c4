// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/frontend_node/outbox.h"

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <utility>

namespace planecloud {
namespace {

constexpr int kMaxDoublings = 3;

}  // namespace

void LinkOptions::check() const {
  checkRange("link/backend_timeout", backend_timeout, 1.0, 86400.0);
  checkRange("link/outbox_bytes", outbox_bytes, 0.0, 1e11);
  checkRange("link/resend_after", resend_after, 0.1, 60.0);
  checkRange("link/resend_window", resend_window, 1e3, 1e9);
  if (bytes_per_second != 0.0) checkRange("link/bytes_per_second", bytes_per_second, 200.0, 1e9);
}

bool Outbox::Peer::has(std::int64_t number) const {
  if (number <= highest) return true;
  if (number > last) return false;
  return !std::binary_search(gaps.begin(), gaps.end(), static_cast<std::uint32_t>(number));
}

Outbox::Outbox(const LinkOptions& options, std::string robot, std::uint64_t session)
    : options_(options), robot_(std::move(robot)), session_(session) {
  options_.check();
}

void Outbox::add(std::shared_ptr<const Keyframe> keyframe, std::size_t bytes, double now) {
  if (!options_.acknowledge) return;
  forgetSilentPeers(now);
  const std::uint32_t number = keyframe->id.number;
  if (!entries_.empty() && number <= entries_.rbegin()->first) {
    throw std::invalid_argument("keyframe " + toString(keyframe->id) +
                                " enters the outbox out of order: numbers must ascend");
  }
  Entry entry;
  entry.bytes = bytes;
  entry.keyframe = std::move(keyframe);
  entry.sent = next_transmission_++;
  stored_bytes_ += entry.bytes;
  entries_.emplace_hint(entries_.end(), number, std::move(entry));
  dropExcess();
}

void Outbox::acknowledge(const KeyframeReceipt& receipt, double now) {
  if (!options_.acknowledge) return;
  forgetSilentPeers(now);
  const bool known = peers_.count(receipt.backend) > 0;
  Peer& peer = peers_[receipt.backend];
  Peer before = peer;
  if (receipt.robot == robot_ && receipt.session == session_) {
    peer.highest = receipt.highest;
    peer.last = std::max(receipt.last, receipt.highest);
    peer.gaps = receipt.gaps;
    std::sort(peer.gaps.begin(), peer.gaps.end());
  } else if (receipt.robot.empty()) {
    peer.highest = peer.last = -1;
    peer.gaps.clear();
  }
  const bool restarted = peer.highest < before.highest || peer.last < before.last;
  // After silence, once, what the link still holds gets time to arrive.
  const bool back = now - before.heard > options_.resend_after && !peer.was_awaited;
  if (!known || restarted) {
    // What it has arrived in order; having nothing, it began to listen after all was sent.
    peer.lost_before = peer.last < 0 ? next_transmission_ : 0;
    before = Peer();
  }
  if (!known || restarted || back) peer.progress = now;
  peer.was_awaited = peer.was_awaited || back;
  peer.heard = now;
  noteProgress(before, peer, now);
  dropExcess();
}

void Outbox::noteProgress(const Peer& before, Peer& after, double now) {
  for (auto& [number, entry] : entries_) {
    if (static_cast<std::int64_t>(number) > after.last) break;
    if (before.has(number) || !after.has(number)) continue;
    entry.acknowledged = true;
    after.progress = now;
    after.stalls = 0;
    after.was_awaited = false;
    after.lost_before = std::max(after.lost_before, entry.sent);
  }
}

void Outbox::noteStall(Peer& peer, double now) {
  const bool complete = std::all_of(entries_.begin(), entries_.end(),
                                    [&](const auto& entry) { return peer.has(entry.first); });
  if (complete) {
    peer.progress = now;
    peer.stalls = 0;
    return;
  }
  const double patience = options_.resend_after * (1 << std::min(peer.stalls, kMaxDoublings));
  if (now - peer.progress < patience) return;
  peer.lost_before = next_transmission_;
  peer.progress = now;
  ++peer.stalls;
}

void Outbox::takeLost(const Peer& peer, std::map<std::uint32_t, Entry*>& due) {
  double under_way = 0.0;
  for (auto& [number, entry] : entries_) {
    const bool on_its_way =
        due.count(number) > 0 || (entry.resent && entry.sent >= peer.lost_before);
    if (on_its_way && !peer.has(number)) under_way += static_cast<double>(entry.bytes);
  }
  for (auto& [number, entry] : entries_) {
    if (peer.has(number) || entry.sent >= peer.lost_before || due.count(number) > 0) continue;
    const double bytes = static_cast<double>(entry.bytes);
    if (under_way > 0.0 && under_way + bytes > options_.resend_window) break;
    under_way += bytes;
    due.emplace(number, &entry);
  }
}

std::vector<std::shared_ptr<const Keyframe>> Outbox::takeDue(double now, std::size_t most_bytes) {
  forgetSilentPeers(now);
  std::map<std::uint32_t, Entry*> due;
  for (auto& [name, peer] : peers_) {
    if (now - peer.heard > options_.resend_after) continue;  // its link is down: let it come back
    noteStall(peer, now);
    takeLost(peer, due);
  }
  std::vector<std::shared_ptr<const Keyframe>> keyframes;
  std::size_t bytes = 0;
  for (auto& [number, entry] : due) {
    bytes += entry->bytes;
    if (bytes > most_bytes) break;
    entry->sent = next_transmission_++;
    entry->resent = true;
    ++resent_;
    keyframes.push_back(entry->keyframe);
  }
  dropExcess();
  return keyframes;
}

void Outbox::forgetSilentPeers(double now) {
  for (auto peer = peers_.begin(); peer != peers_.end();) {
    const bool silent = now - peer->second.heard > options_.backend_timeout;
    peer = silent ? peers_.erase(peer) : std::next(peer);
  }
}

bool Outbox::isWanted(std::uint32_t number) const {
  return std::any_of(peers_.begin(), peers_.end(),
                     [&](const auto& peer) { return !peer.second.has(number); });
}

void Outbox::dropExcess() {
  for (auto entry = entries_.begin();
       entry != entries_.end() && static_cast<double>(stored_bytes_) > options_.outbox_bytes;) {
    if (isWanted(entry->first)) {
      ++entry;
      continue;
    }
    ++(entry->second.acknowledged ? forgotten_ : given_up_);
    stored_bytes_ -= entry->second.bytes;
    entry = entries_.erase(entry);
  }
}

std::size_t Outbox::unacknowledged() const {
  return static_cast<std::size_t>(std::count_if(
      entries_.begin(), entries_.end(), [&](const auto& entry) { return isWanted(entry.first); }));
}

OutboxStatistics Outbox::statistics() const {
  OutboxStatistics statistics;
  statistics.stored = entries_.size();
  statistics.stored_bytes = stored_bytes_;
  statistics.unacknowledged = unacknowledged();
  statistics.resent = resent_;
  statistics.given_up = given_up_;
  statistics.forgotten = forgotten_;
  statistics.backends = peers_.size();
  return statistics;
}

}  // namespace planecloud

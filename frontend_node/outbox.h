// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "planecloud_slam/plane_fit/keyframe.h"
#include "planecloud_slam/plane_fit/option_fields.h"

namespace planecloud {

/// How keyframes are kept and sent again. Keys: `link/...`.
struct LinkOptions {
  /// Keep keyframes until they are acknowledged and send again what is missing; false: send once.
  bool acknowledge = true;
  /// A keyframe is kept for every backend heard within this time [s], [1, 86400].
  double backend_timeout = 300.0;
  /// Bytes of acknowledged keyframes kept for late or restarted backends [B], [0, 1e11].
  double outbox_bytes = 64e6;
  /// Without any progress a backend is given the rest again after this time, doubled each time up
  /// to eight times [s], [0.1, 60].
  double resend_after = 3.0;
  /// Most bytes sent again that may be under way to a backend: half a second of the slowest link
  /// [B], [1e3, 1e9].
  double resend_window = 64e3;
  /// Most bytes per second sent, over any 5 s and counting whole messages [B/s], 0: no limit, else
  /// [200, 1e9]. Keyframes get coarser planes where their full ones would not fit, and wait for
  /// room where even those do not.
  double bytes_per_second = 0.0;

  template <typename Self, typename Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("acknowledge", self.acknowledge);
    visit("backend_timeout", self.backend_timeout);
    visit("outbox_bytes", self.outbox_bytes);
    visit("resend_after", self.resend_after);
    visit("resend_window", self.resend_window);
    visit("bytes_per_second", self.bytes_per_second);
  }
  /// Throws std::invalid_argument naming key, value and range.
  void check() const;
};

/// What one backend says it has of one frontend's keyframes. Robot "" says that it listens and has
/// nothing at all; a receipt for another session says so to frontends it did not yet mention.
struct KeyframeReceipt {
  std::string backend;              ///< unique name of the backend, the same when it restarts
  std::string robot;                ///< whose keyframes
  std::uint64_t session = 0;        ///< of which run
  std::int64_t highest = -1;        ///< all keyframes up to here are there; -1: not even number 0
  std::int64_t last = -1;           ///< the highest number that is there; -1: none
  std::vector<std::uint32_t> gaps;  ///< missing between `highest` and `last`, ascending
};

struct OutboxStatistics {
  std::size_t stored = 0;  ///< keyframes kept now
  std::size_t stored_bytes = 0;
  std::size_t unacknowledged = 0;  ///< of them: missing at some backend heard within the timeout
  std::size_t resent = 0;          ///< transmissions beyond each keyframe's first
  std::size_t given_up = 0;        ///< dropped although no backend ever acknowledged them
  std::size_t forgotten = 0;       ///< dropped from history: late backends will miss them
  std::size_t backends = 0;        ///< heard within the timeout
};

/// Keeps sent keyframes until every backend heard lately has them, then as history, and says what
/// to send again. Assumes only that a link delivers in the order of sending: what was sent before
/// something that arrived, and is not there, is lost. Times are seconds of any clock that never
/// goes back. Not for several threads at once.
class Outbox {
 public:
  /// Throws std::invalid_argument when `options` fail their check.
  Outbox(const LinkOptions& options, std::string robot, std::uint64_t session);

  /// Takes a keyframe of `bytes` on the wire that is being sent at `now`; numbers must ascend.
  void add(std::shared_ptr<const Keyframe> keyframe, std::size_t bytes, double now);

  void acknowledge(const KeyframeReceipt& receipt, double now);

  /// Keyframes to send again at `now`, oldest first, together at most `most_bytes`; counts them as
  /// sent.
  [[nodiscard]] std::vector<std::shared_ptr<const Keyframe>> takeDue(
      double now, std::size_t most_bytes = std::numeric_limits<std::size_t>::max());

  /// How many keyframes some backend heard within the timeout has not said to have.
  [[nodiscard]] std::size_t unacknowledged() const;
  [[nodiscard]] OutboxStatistics statistics() const;

 private:
  struct Entry {
    std::shared_ptr<const Keyframe> keyframe;
    std::size_t bytes = 0;
    std::uint64_t sent = 0;  ///< number of its latest transmission
    bool resent = false;
    bool acknowledged = false;  ///< by any backend, ever
  };
  struct Peer {
    std::int64_t highest = -1;
    std::int64_t last = -1;  ///< highest number known to have arrived
    std::vector<std::uint32_t> gaps;
    double heard = 0.0;
    double progress = 0.0;     ///< when it last acknowledged something new, or began to be heard
    int stalls = 0;            ///< times it was given everything again since then
    bool was_awaited = false;  ///< after a silence since then
    /// Transmissions below this number that are not acknowledged are lost.
    std::uint64_t lost_before = 0;

    [[nodiscard]] bool has(std::int64_t number) const;
  };
  using Entries = std::map<std::uint32_t, Entry>;

  void noteProgress(const Peer& before, Peer& after, double now);
  void noteStall(Peer& peer, double now);
  void takeLost(const Peer& peer, std::map<std::uint32_t, Entry*>& due);
  void forgetSilentPeers(double now);
  [[nodiscard]] bool isWanted(std::uint32_t number) const;
  void dropExcess();

  LinkOptions options_;
  std::string robot_;
  std::uint64_t session_;
  Entries entries_;
  std::map<std::string, Peer> peers_;
  std::uint64_t next_transmission_ = 1;
  std::size_t stored_bytes_ = 0;
  std::size_t resent_ = 0;
  std::size_t given_up_ = 0;
  std::size_t forgotten_ = 0;
};

}  // namespace planecloud

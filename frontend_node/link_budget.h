// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <deque>
#include <limits>

namespace planecloud {

/// Keeps what is sent below a rate: in no window of `kWindow` seconds more than `kWindow` times the
/// rate goes out. What a quiet time left unused may be sent at once. Times are seconds of any clock
/// that never goes back. Not for several threads at once.
class LinkBudget {
 public:
  static constexpr double kWindow = 5.0;  ///< [s]
  static constexpr std::size_t kUnlimited = std::numeric_limits<std::size_t>::max();

  /// `bytes_per_second` [B/s], 0: no limit.
  explicit LinkBudget(double bytes_per_second = 0.0) : rate_(bytes_per_second) {}

  /// Holds from now on, also over what was sent already.
  void setRate(double bytes_per_second) { rate_ = bytes_per_second; }
  [[nodiscard]] bool isLimited() const { return rate_ > 0.0; }

  /// Bytes that may go at `now`, `kUnlimited` without a limit.
  [[nodiscard]] std::size_t available(double now);

  /// Whether a message of this size may go at `now`. One that no window could ever hold may go when
  /// the window is empty: late is better than never.
  [[nodiscard]] bool admits(std::size_t bytes, double now);

  /// Counts a message that goes at `now`.
  void spend(std::size_t bytes, double now);

 private:
  struct Sent {
    double time;
    std::size_t bytes;
  };
  void forgetBefore(double time);

  double rate_;  ///< [B/s]
  std::deque<Sent> sent_;
  std::size_t sent_bytes_ = 0;  ///< of `sent_`
};

}  // namespace planecloud

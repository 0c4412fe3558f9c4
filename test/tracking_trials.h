// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "frame_set.h"
#include "planecloud_slam/frontend_node/frontend.h"

namespace planecloud {

/// A recording into which something happens.
struct Trial {
  std::string name;
  FrameSet set;
  /// Frames [begin, end) are disturbed; from `end` on images are good again.
  std::size_t begin = 0;
  std::size_t end = 0;
  /// The disturbed images show nothing of the world: every one of them must be called lost.
  bool is_blind = false;
};

/// Everything that the trials of loss do to `set`, at a place chosen by `seed`. The set should hold
/// 9 s or more.
[[nodiscard]] std::vector<Trial> makeTrials(const FrameSet& set, std::uint64_t seed);

/// A camera of the built-in world that turns on the spot at 120 degrees per second, stops, and
/// turns back.
[[nodiscard]] Trial makeFastTurn(std::uint64_t seed, const CameraIntrinsics& camera);

/// What became of a trial.
struct TrialOutcome {
  std::size_t wrong = 0;        ///< frames called good, off by more than 10 cm from their keyframe
  double worst = 0.0;           ///< largest such error of a good frame [m]
  std::size_t blind_good = 0;   ///< disturbed frames of a blind trial that were called good
  bool seen_before = false;     ///< the first good image shows what a keyframe had seen
  double regained_after = 0.0;  ///< from the first good image to the first good frame [s]
  bool same_segment = false;    ///< no new segment opened
  int segments = 0;
};

/// Stamps of keyframes [s].
using KeyframeStamps = std::map<KeyframeId, double>;

/// Judges one run over the trial's frames; `stamps` are those of all its keyframes.
[[nodiscard]] TrialOutcome judgeTrial(const Trial& trial, const std::vector<FrameResult>& results,
                                      const KeyframeStamps& stamps);

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "planecloud_slam/frontend_node/frontend.h"
#include "planecloud_slam/plane_fit/keyframe.h"

namespace planecloud {

/// A keyframe as the backend receives it, and what it cost.
struct ReplayedKeyframe {
  Keyframe keyframe;
  double fit_time = 0.0;  ///< fitting, coding and describing it [s]
};

/// One step of one robot's frontend.
struct ReplayedFrame {
  std::size_t robot = 0;                    ///< index of the recording
  double stamp = 0.0;                       ///< [s]
  std::optional<FrameResult> result;        ///< none: the end of the recording
  double track_time = 0.0;                  ///< [s]
  std::vector<ReplayedKeyframe> keyframes;  ///< completed by this step
  std::string note;                         ///< for people, normally empty
};

/// Gives one step after the other, nothing at the end; may throw.
using FrameStream = std::function<std::optional<ReplayedFrame>()>;

/// Always the earliest of the next steps of all streams, the first stream's when two are equal.
/// Merging in groups and then the groups gives the same order.
[[nodiscard]] FrameStream mergeByStamp(std::vector<FrameStream> streams);

/// The same steps, taken from `stream` by a thread of its own that runs up to `ahead` steps ahead.
[[nodiscard]] FrameStream readAhead(FrameStream stream, std::size_t ahead);

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include "planecloud_slam/frontend_node/frontend_options.h"
#include "planecloud_slam/frontend_node/keyframe_compressor.h"
#include "planecloud_slam/rosbags/frame_stream.h"
#include "planecloud_slam/rosbags/recording.h"

namespace planecloud {

/// What the frontends of a replay are told.
struct RobotReplayOptions {
  FrontendOptions frontend;
  std::size_t max_frames = 0;  ///< frames taken from each recording, 0: all
  bool history = true;         ///< false: keyframes keep only the edge to the previous one
  std::size_t read_ahead = 0;  ///< frames read by a thread of their own, 0: none
};

/// One robot's frontend fed from its recording: tracking, fitting, rounding to what travels.
class RobotReplay {
 public:
  /// `index`: the robot's number among those replayed. Throws std::invalid_argument for options or
  /// a camera that fail their check.
  RobotReplay(std::shared_ptr<Recording> recording, std::size_t index,
              const RobotReplayOptions& options);
  ~RobotReplay();
  RobotReplay(RobotReplay&&) noexcept;
  RobotReplay& operator=(RobotReplay&&) noexcept;

  /// The next step; the last one, without a frame, completes the open keyframe.
  [[nodiscard]] std::optional<ReplayedFrame> next();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace planecloud

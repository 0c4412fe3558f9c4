// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "planecloud_slam/frontend_node/frontend.h"
#include "planecloud_slam/frontend_node/frontend_node_options.h"
#include "planecloud_slam/frontend_node/odometry_source.h"
#include "planecloud_slam/frontend_node/rgbd_input.h"

namespace planecloud {

/// A frame, what tracking says of it, and where it came from.
struct TrackedFrame {
  RgbdFrame frame;
  FrameResult result;
  CameraIntrinsics camera;   ///< of the frame, lens distortion included
  std::string camera_frame;  ///< tf frame of the optical axes
};

/// How the images of a frame are to be read.
struct ImageReading {
  bool rectified = false;    ///< they are, see RectifyMode
  bool wants_color = false;  ///< for the texture
};

/// The tracker as images feed it: decodes them, builds the frontend when the first camera info is
/// there and goes on in a new segment when the camera or time changes. For one thread.
class FrameTracker {
 public:
  /// `odometry` must outlive the tracker.
  FrameTracker(const FrontendNodeOptions& options, std::string robot, std::uint64_t session,
               OdometrySource& odometry);

  /// Throws MessageError or std::invalid_argument naming the cure for images that cannot be used.
  [[nodiscard]] TrackedFrame track(const InputFrame& input, const ImageReading& reading);

  /// Keyframes completed so far, oldest first; empties the list.
  [[nodiscard]] std::vector<CompletedKeyframe> takeCompleted();
  /// Completes the open keyframe.
  void finish();

  /// See Frontend::setKeyframeOptions.
  void setKeyframeOptions(const KeyframeSelectorOptions& options);

  /// tf frame of the last camera tracked.
  [[nodiscard]] const std::string& cameraFrame() const { return camera_frame_; }

 private:
  void useCamera(const CameraIntrinsics& camera);
  void placeSegment(double stamp);

  FrontendOptions options_;
  const std::string robot_;
  const std::uint64_t session_;
  OdometrySource& odometry_;
  std::optional<Frontend> frontend_;
  CameraIntrinsics camera_;
  std::string camera_frame_;
  bool is_placed_ = false;
  int time_jumps_ = 0;  ///< that were followed
};

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "planecloud_slam/frontend_node/frontend_options.h"
#include "planecloud_slam/frontend_node/keyframe_view.h"
#include "planecloud_slam/plane_fit/camera.h"
#include "planecloud_slam/plane_fit/image_view.h"
#include "planecloud_slam/plane_fit/keyframe.h"
#include "planecloud_slam/plane_fit/rgb8.h"

namespace planecloud {

/// One colour-depth pair in one camera, as it came from the sensor (not rectified).
struct RgbdFrame {
  double stamp = 0.0;        ///< of the depth image [s since the epoch]
  Image<std::uint8_t> grey;  ///< width x height, 0..255
  Image<float> depth;        ///< width x height, along the optical axis [m]; NaN: none
  Image<Rgb8> color;         ///< width x height, or empty: only the texture is made of it
  double color_delay = 0.0;  ///< stamp of the colour image less that of the depth image [s]
};

enum class TrackingStatus {
  kInitialised,  ///< first frame of a segment: it is the reference
  kTracked,      ///< aligned to the keyframe the frame before was aligned to, or its successor
  kRelocalised,  ///< found again against an earlier keyframe: the pose may jump
  kLost,
};

/// What tracking says of one frame.
struct FrameResult {
  TrackingStatus status = TrackingStatus::kLost;
  std::string reason;  ///< why it was lost, for people; empty otherwise
  double stamp = 0.0;  ///< [s]
  /// Of lost frames: where the wheels say, if they do, else where it was last known.
  Eigen::Isometry3d T_odom_camera = Eigen::Isometry3d::Identity();
  /// Counts pieces of the track whose relation is unknown; a new one begins with kInitialised.
  int segment = 0;
  /// Reference keyframe and the pose relative to it, so that trajectories move with the graph.
  KeyframeId reference;
  Eigen::Isometry3d T_reference_camera = Eigen::Isometry3d::Identity();
  Matrix6d information = Matrix6d::Zero();  ///< of T_reference_camera
  double overlap = 0.0;                     ///< share of the reference's points seen, [0, 1]
  double inliers = 0.0;                     ///< share of these whose depth agrees to 5 %, [0, 1]
  double grey_residual = 0.0;               ///< scale of the grey residuals [grey levels]
};

/// A keyframe whose tracking is over and whose depth waits to be fitted. Movable between threads.
struct CompletedKeyframe {
  Keyframe keyframe;   ///< all but the planes
  Image<float> depth;  ///< [m], NaN: none; rectified, in `camera`
  Image<std::uint8_t> grey;
  CameraIntrinsics camera;
  Image<Rgb8> color;    ///< may be empty
  HistoryTask history;  ///< what `KeyframeCompressor` aligns it with
};

/// The tracking half of the frontend: DVO against the local map of one keyframe (paper sec. 3.1).
/// No threads, no clock, no logging.
class Frontend {
 public:
  /// Throws std::invalid_argument when `options` or `camera` fail their check.
  Frontend(const FrontendOptions& options, const CameraIntrinsics& camera, std::string robot,
           std::uint64_t session);
  ~Frontend();
  Frontend(Frontend&&) noexcept;
  Frontend& operator=(Frontend&&) noexcept;

  /// Tracks one frame. `T_previous_current`, when given, is the motion of the optical frame since
  /// the previous call from elsewhere (wheel odometry). A lost camera is looked for in the
  /// short-term history. A stamp before the previous one begins a new segment; so does a good image
  /// after `lost/new_segment_after` without a track, unless the wheels know the way to it.
  /// Throws std::invalid_argument when the frame's size is not the camera's.
  [[nodiscard]] FrameResult track(const RgbdFrame& frame,
                                  const std::optional<Eigen::Isometry3d>& T_previous_current = {});

  /// Keyframes completed by the calls so far, oldest first; empties the list.
  [[nodiscard]] std::vector<CompletedKeyframe> takeCompleted();

  /// Completes the current keyframe (end of a recording, shutdown); the next frame opens a segment.
  void finish();

  /// Ends the segment and forgets the short-term history: time went backwards. The open keyframe is
  /// completed.
  void startNewSegment();

  /// Goes on with another camera: ends the segment and keeps counting keyframes.
  /// Throws std::invalid_argument, and changes nothing, when `camera` fails its check.
  void changeCamera(const CameraIntrinsics& camera);

  /// Goes on with other thresholds. Throws, and changes nothing, when they fail their check.
  void setKeyframeOptions(const KeyframeSelectorOptions& options);

  /// Where the next segment begins, T_odom_camera of its first frame; else a levelled camera at
  /// the origin that looks along x, and after a loss the last known pose.
  void setNextPose(const Eigen::Isometry3d& T_odom_camera);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "planecloud_slam/frontend_node/frontend.h"
#include "planecloud_slam/frontend_node/keyframe_view.h"
#include "planecloud_slam/frontend_node/local_map.h"

namespace planecloud {

/// An image that other images are aligned with.
struct TrackedReference {
  KeyframeViewPtr view;
  std::shared_ptr<const TrackingReference> points;
};

/// The keyframe that is being made: opened with a frame, improved by the frames tracked against it,
/// completed when the camera leaves it.
class OpenKeyframe {
 public:
  /// Throws std::invalid_argument when options or camera fail their check.
  OpenKeyframe(const LocalMapOptions& options, const CameraIntrinsics& camera);

  [[nodiscard]] bool isOpen() const { return is_open_; }

  /// Opens the keyframe of `reference` with `frame`, linked by `edges`.
  void open(RgbdFrame frame, TrackedReference reference, std::vector<RelativePoseEdge> edges);
  /// Improves the depth by that of a frame [m] at `T_keyframe_camera`; nothing when none is open.
  void fuse(ImageView<float> depth, const Eigen::Isometry3d& T_keyframe_camera);
  /// Closes it; `earlier` are the keyframes it may be aligned with. Requires isOpen().
  [[nodiscard]] CompletedKeyframe complete(std::vector<KeyframeViewPtr> earlier);

 private:
  CameraIntrinsics camera_;
  LocalMap local_map_;
  bool is_open_ = false;
  Keyframe keyframe_;
  Image<std::uint8_t> grey_;
  Image<Rgb8> color_;
  TrackedReference reference_;
};

}  // namespace planecloud

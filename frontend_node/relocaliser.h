// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <optional>

#include "planecloud_slam/frontend_node/dense_tracker.h"
#include "planecloud_slam/frontend_node/history_options.h"
#include "planecloud_slam/frontend_node/keyframe_view.h"

namespace planecloud {

/// An earlier keyframe found again, and the live image aligned to it.
struct Relocalisation {
  KeyframeViewPtr view;
  std::shared_ptr<const TrackingReference> reference;  ///< of `view`
  Alignment alignment;                                 ///< T_view_live
};

/// Recognises earlier keyframes in the images of a lost camera: those that look alike are aligned
/// in both directions, and what is accepted must agree. One per thread.
class Relocaliser {
 public:
  /// Throws std::invalid_argument when options fail their check.
  Relocaliser(const HistoryOptions& options, const DenseTrackerOptions& tracking);

  /// The first keyframe of `views` that the live image can be aligned with, those most alike
  /// first; none when there is no doubtless one.
  [[nodiscard]] std::optional<Relocalisation> find(const RgbdPyramid& live,
                                                   const std::deque<KeyframeViewPtr>& views);

 private:
  [[nodiscard]] std::optional<Relocalisation> alignWith(
      const KeyframeViewPtr& view, const TrackingReference& live_reference, const RgbdPyramid& live,
      const std::vector<Eigen::Isometry3d>& starts);
  [[nodiscard]] bool isDoubtless(const Alignment& alignment) const;

  HistoryOptions options_;
  DenseTrackerOptions tracking_;
  DenseTracker tracker_;
};

}  // namespace planecloud

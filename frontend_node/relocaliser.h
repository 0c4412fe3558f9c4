// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <functional>
#include <optional>
#include <vector>

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

/// Where a camera may be after a gap.
struct ExpectedPlace {
  KeyframeViewPtr view;
  std::shared_ptr<const TrackingReference> reference;  ///< of `view`; none: it is made
  std::vector<Eigen::Isometry3d> T_view_live;          ///< candidates, at least one
};

/// Recognises earlier keyframes in the images of a lost camera: those that look alike are aligned
/// in both directions, and what is accepted must agree. One per thread.
class Relocaliser {
 public:
  /// Throws std::invalid_argument when options fail their check.
  Relocaliser(const HistoryOptions& options, const DenseTrackerOptions& tracking);

  /// See DenseTracker::setPlanarMotion.
  void setPlanarMotion(const std::optional<PlanarMotion>& planar) {
    tracker_.setPlanarMotion(planar);
  }

  /// True when an alignment leaves no doubt (see LossDetector::findDoubt).
  using Judge = std::function<bool(const Alignment&, bool is_lenient)>;

  /// The first of `places` that the live image can be aligned with beyond doubt; else the first
  /// such of `views`, those most alike first; else none.
  [[nodiscard]] std::optional<Relocalisation> find(const RgbdPyramid& live,
                                                   const std::vector<ExpectedPlace>& places,
                                                   const std::deque<KeyframeViewPtr>& views,
                                                   const Judge& is_doubtless);

 private:
  struct Live {
    const RgbdPyramid& pyramid;
    TrackingReference reference;
    const Judge& is_doubtless;
  };
  /// One of two images that are aligned with each other.
  struct Side {
    const TrackingReference& reference;
    const RgbdPyramid& pyramid;
  };
  struct BothWays {
    Alignment second_in_first, first_in_second;
  };
  [[nodiscard]] std::optional<BothWays> alignBothWays(
      const Side& first, const Side& second, const std::vector<Eigen::Isometry3d>& T_first_second,
      const Live& live);
  [[nodiscard]] static bool isDoubtless(const BothWays& found, const Live& live);
  [[nodiscard]] std::optional<Relocalisation> alignWith(const ExpectedPlace& place,
                                                        const Live& live);
  [[nodiscard]] std::vector<ExpectedPlace> findAlike(
      const RgbdPyramid& live, const std::deque<KeyframeViewPtr>& views) const;

  HistoryOptions options_;
  DenseTrackerOptions tracking_;
  DenseTracker tracker_;
};

}  // namespace planecloud

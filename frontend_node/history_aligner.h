// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "planecloud_slam/frontend_node/dense_tracker.h"
#include "planecloud_slam/frontend_node/history_options.h"
#include "planecloud_slam/frontend_node/keyframe_view.h"

namespace planecloud {

/// What the short-term history says of a keyframe.
struct HistoryLinks {
  std::vector<RelativePoseEdge> edges;  ///< measured, at most `history/edges`
  std::vector<KeyframeId> hints;        ///< keyframes that look alike but could not be aligned
};

/// Aligns a completed keyframe with earlier ones whose view it shares: the additional constraints
/// that hold a trajectory together (Kerl 2013b sec. IV-C). One per thread.
class HistoryAligner {
 public:
  /// Throws std::invalid_argument when options fail their check.
  HistoryAligner(const HistoryOptions& options, const DenseTrackerOptions& tracking);

  /// Edges from the task's keyframe to earlier ones, those in `known` left out.
  [[nodiscard]] HistoryLinks align(const HistoryTask& task,
                                   const std::vector<RelativePoseEdge>& known);

 private:
  struct Candidate {
    KeyframeViewPtr view;
    std::vector<Eigen::Isometry3d> starts;  ///< T_this_view
    double worth = 0.0;                     ///< the best are tried first
    bool located = false;                   ///< the start comes from odometry
  };
  [[nodiscard]] std::vector<Candidate> findCandidates(const HistoryTask& task,
                                                      const std::vector<RelativePoseEdge>& known);
  [[nodiscard]] bool isMeasured(const Candidate& candidate, const Alignment& alignment) const;

  HistoryOptions options_;
  DenseTrackerOptions tracking_;
  DenseTracker tracker_;
  Residuals residuals_;
};

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/frontend_node/history_aligner.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "planecloud_slam/plane_fit/appearance_descriptor.h"

namespace planecloud {
namespace {

/// Odometry between keyframes of the history drifts less than this; an alignment that ends
/// farther from it found something else.
constexpr double kMaxCorrection = 0.15;     // [m]
constexpr double kMaxTurnCorrection = 0.1;  // [rad]
/// Where the relation is unknown nothing else vouches for an alignment.
constexpr double kUnknownMinInliers = 0.85;

/// Depth ratio beyond which one image shows the other's surfaces at another resolution, which
/// biased alignments along the axis by a centimetre in the hallway.
constexpr double kMaxZoom = 0.12;

/// Motion along the optical axis as a share of the points' mean distance.
double zoom(const ReferencePoints& points, const Eigen::Isometry3d& T) {
  double sum = 0.0;
  for (std::size_t i = 0; i < points.count; ++i) sum += static_cast<double>(points.q[i]);
  const auto count = static_cast<double>(std::max<std::size_t>(points.count, 1));
  return std::abs(T.translation().z()) * sum / count;
}

}  // namespace

HistoryAligner::HistoryAligner(const HistoryOptions& options, const DenseTrackerOptions& tracking)
    : options_(options), tracking_(tracking.withoutPrior()), tracker_(tracking_) {
  options_.check();
}

std::vector<HistoryAligner::Candidate> HistoryAligner::findCandidates(
    const HistoryTask& task, const std::vector<RelativePoseEdge>& known) {
  const ReferencePoints& points = task.reference->levels().back();
  std::vector<Candidate> candidates;
  for (const KeyframeViewPtr& view : task.earlier) {
    const bool is_known =
        std::any_of(known.begin(), known.end(),
                    [&](const RelativePoseEdge& edge) { return edge.other == view->id; });
    if (is_known) continue;
    Candidate candidate{view, {}, 0.0, view->segment == task.view->segment};
    if (candidate.located) {
      const Eigen::Isometry3d T_this_view =
          task.view->T_odom_camera.inverse() * view->T_odom_camera;
      if (zoom(points, T_this_view) > kMaxZoom) continue;
      const RgbdLevel& coarse = view->pyramid.levels().back();
      computeResiduals(points, coarse, T_this_view.inverse(), {}, residuals_);
      const double share = static_cast<double>(residuals_.seen_count) /
                           static_cast<double>(std::max<std::size_t>(points.count, 1));
      if (share < options_.min_overlap) continue;
      candidate.starts = {T_this_view};
      // Drift grows with the number of keyframes between: the oldest that still fit bind most.
      candidate.worth = static_cast<double>(task.view->id.number - view->id.number);
    } else {
      const auto comparison = compareAppearance(task.view->descriptor, view->descriptor);
      if (!comparison || comparison->dissimilarity > options_.max_dissimilarity) continue;
      const LevelCamera& camera = view->pyramid.levels().front().camera;
      candidate.starts = {turnByShift(camera, comparison->shift_x, comparison->shift_y),
                          Eigen::Isometry3d::Identity()};
      candidate.worth = 1.0 - comparison->dissimilarity;
    }
    candidates.push_back(std::move(candidate));
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.worth > b.worth; });
  return candidates;
}

bool HistoryAligner::isMeasured(const Candidate& candidate, const Alignment& alignment) const {
  if (alignment.status != AlignmentStatus::kConverged || alignment.overlap < options_.min_overlap ||
      alignment.inliers < options_.min_inliers) {
    return false;
  }
  if (!candidate.located) return alignment.inliers >= kUnknownMinInliers;
  const Eigen::Isometry3d correction =
      candidate.starts.front().inverse() * alignment.T_reference_current;
  return correction.translation().norm() < kMaxCorrection &&
         rotationAngle(correction) < kMaxTurnCorrection;
}

HistoryLinks HistoryAligner::align(const HistoryTask& task,
                                   const std::vector<RelativePoseEdge>& known) {
  HistoryLinks links;
  if (!task.view || options_.edges == 0) return links;
  int trials = 0;
  for (const Candidate& candidate : findCandidates(task, known)) {
    if (static_cast<int>(links.edges.size()) == options_.edges || trials == options_.trials) break;
    ++trials;
    const Alignment alignment =
        tracker_.align(*task.reference, candidate.view->pyramid, {candidate.starts, {}});
    if (isMeasured(candidate, alignment)) {
      const Eigen::Isometry3d T_view_this = alignment.T_reference_current.inverse();
      links.edges.push_back(
          {candidate.view->id, T_view_this,
           invertRelativePoseInformation(alignment.T_reference_current, alignment.information)});
    } else if (!candidate.located) {
      links.hints.push_back(candidate.view->id);
    }
  }
  return links;
}

}  // namespace planecloud

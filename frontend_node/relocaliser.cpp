// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/frontend_node/relocaliser.h"

#include <algorithm>
#include <utility>

#include "planecloud_slam/plane_fit/appearance_descriptor.h"

namespace planecloud {
namespace {

/// What alignments in both directions may differ by: more, and one of them is elsewhere.
constexpr double kMaxDisagreement = 0.03;      // [m]
constexpr double kMaxTurnDisagreement = 0.02;  // [rad]
constexpr double kMinInliers = 0.8;
/// Grey residuals of the same surface under the same light [grey levels].
constexpr double kMaxGreyScale = 15.0;

}  // namespace

Relocaliser::Relocaliser(const HistoryOptions& options, const DenseTrackerOptions& tracking)
    : options_(options), tracking_(tracking.withoutPrior()), tracker_(tracking_) {
  options_.check();
}

bool Relocaliser::isDoubtless(const Alignment& alignment) const {
  return alignment.status == AlignmentStatus::kConverged &&
         alignment.overlap >= options_.min_overlap && alignment.inliers >= kMinInliers &&
         alignment.scale.sigma_grey <= kMaxGreyScale;
}

std::optional<Relocalisation> Relocaliser::alignWith(const KeyframeViewPtr& view,
                                                     const TrackingReference& live_reference,
                                                     const RgbdPyramid& live,
                                                     const std::vector<Eigen::Isometry3d>& starts) {
  const Alignment to_view = tracker_.align(live_reference, view->pyramid, {starts, {}});
  if (!isDoubtless(to_view)) return std::nullopt;
  auto reference = std::make_shared<const TrackingReference>(view->pyramid, tracking_);
  const Alignment from_view =
      tracker_.align(*reference, live, {{to_view.T_reference_current.inverse()}, {}});
  if (!isDoubtless(from_view)) return std::nullopt;
  const Eigen::Isometry3d loop = to_view.T_reference_current * from_view.T_reference_current;
  if (loop.translation().norm() > kMaxDisagreement || rotationAngle(loop) > kMaxTurnDisagreement) {
    return std::nullopt;
  }
  return Relocalisation{view, std::move(reference), from_view};
}

std::optional<Relocalisation> Relocaliser::find(const RgbdPyramid& live,
                                                const std::deque<KeyframeViewPtr>& views) {
  struct Alike {
    double dissimilarity;
    KeyframeViewPtr view;
    Eigen::Isometry3d T_live_view;
  };
  const std::vector<std::uint8_t> descriptor = describeView(live);
  std::vector<Alike> alike;
  for (const KeyframeViewPtr& view : views) {
    const auto comparison = compareAppearance(descriptor, view->descriptor);
    if (!comparison || comparison->dissimilarity > options_.max_dissimilarity) continue;
    alike.push_back(
        {comparison->dissimilarity, view,
         turnByShift(live.levels().front().camera, comparison->shift_x, comparison->shift_y)});
  }
  if (alike.empty()) return std::nullopt;
  std::stable_sort(alike.begin(), alike.end(), [](const Alike& a, const Alike& b) {
    return a.dissimilarity < b.dissimilarity;
  });
  alike.resize(std::min(alike.size(), static_cast<std::size_t>(options_.candidates)));
  const TrackingReference live_reference(live, tracking_);
  for (const Alike& candidate : alike) {
    std::optional<Relocalisation> found =
        alignWith(candidate.view, live_reference, live,
                  {candidate.T_live_view, Eigen::Isometry3d::Identity()});
    if (found) return found;
  }
  return std::nullopt;
}

}  // namespace planecloud

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
/// Share of either image's points that the other must see.
constexpr double kLeastOverlap = 0.08;

/// Views that look alike may be nearer or farther.
std::vector<Eigen::Isometry3d> startsAround(const Eigen::Isometry3d& turn) {
  std::vector<Eigen::Isometry3d> starts = {turn, Eigen::Isometry3d::Identity()};
  for (const double forwards : {0.4, 0.8, -0.4, -0.8}) {
    starts.push_back(turn * Eigen::Translation3d(0.0, 0.0, forwards));
  }
  return starts;
}

}  // namespace

Relocaliser::Relocaliser(const HistoryOptions& options, const DenseTrackerOptions& tracking)
    : options_(options), tracking_(tracking.withoutPrior()), tracker_(tracking_) {
  options_.check();
}

/// Who has driven on sees little of what was seen before, but nearly nothing else, and sees it from
/// nearby: it is enough that one of the images shares much with the other, and looks like it.
bool Relocaliser::isDoubtless(const BothWays& found, const Live& live) {
  Alignment ways[] = {found.second_in_first, found.first_in_second};
  const double overlap = std::max(ways[0].overlap, ways[1].overlap);
  bool is_alike = false;
  for (Alignment& way : ways) {
    if (way.overlap < kLeastOverlap) return false;
    way.overlap = overlap;
    if (!live.is_doubtless(way, true)) return false;
    is_alike = is_alike || live.is_doubtless(way, false);
  }
  return is_alike;
}

std::optional<Relocaliser::BothWays> Relocaliser::alignBothWays(
    const Side& first, const Side& second, const std::vector<Eigen::Isometry3d>& T_first_second,
    const Live& live) {
  BothWays found;
  found.second_in_first = tracker_.align(first.reference, second.pyramid, {T_first_second, {}});
  Alignment at_best = found.second_in_first;
  at_best.overlap = 1.0;
  if (!live.is_doubtless(at_best, true)) return std::nullopt;
  const Eigen::Isometry3d& T = found.second_in_first.T_reference_current;
  found.first_in_second = tracker_.align(second.reference, first.pyramid, {{T.inverse()}, {}});
  if (!isDoubtless(found, live)) return std::nullopt;
  const Eigen::Isometry3d loop = T * found.first_in_second.T_reference_current;
  if (loop.translation().norm() > kMaxDisagreement || rotationAngle(loop) > kMaxTurnDisagreement) {
    return std::nullopt;
  }
  return found;
}

std::optional<Relocalisation> Relocaliser::alignWith(const ExpectedPlace& place, const Live& live) {
  auto reference = place.reference;
  if (!reference) {
    reference = std::make_shared<const TrackingReference>(place.view->pyramid, tracking_);
  }
  const Side view_side{*reference, place.view->pyramid};
  const Side live_side{live.reference, live.pyramid};
  if (auto found = alignBothWays(view_side, live_side, place.T_view_live, live)) {
    return Relocalisation{place.view, std::move(reference), found->second_in_first};
  }
  // Far ahead, what the live image shows is all in the view, but not the other way round.
  std::vector<Eigen::Isometry3d> T_live_view;
  for (const Eigen::Isometry3d& T : place.T_view_live) T_live_view.push_back(T.inverse());
  if (auto found = alignBothWays(live_side, view_side, T_live_view, live)) {
    return Relocalisation{place.view, std::move(reference), found->first_in_second};
  }
  return std::nullopt;
}

std::vector<ExpectedPlace> Relocaliser::findAlike(const RgbdPyramid& live,
                                                  const std::deque<KeyframeViewPtr>& views) const {
  const std::vector<std::uint8_t> descriptor = describeView(live);
  std::vector<std::pair<double, ExpectedPlace>> alike;
  for (const KeyframeViewPtr& view : views) {
    const auto comparison = compareAppearance(view->descriptor, descriptor);
    if (!comparison || comparison->dissimilarity > options_.max_dissimilarity) continue;
    const Eigen::Isometry3d turn =
        turnByShift(live.levels().front().camera, comparison->shift_x, comparison->shift_y);
    alike.push_back({comparison->dissimilarity, {view, nullptr, startsAround(turn)}});
  }
  std::stable_sort(alike.begin(), alike.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<ExpectedPlace> places;
  for (auto& [dissimilarity, place] : alike) {
    if (places.size() == static_cast<std::size_t>(options_.candidates)) break;
    places.push_back(std::move(place));
  }
  return places;
}

std::optional<Relocalisation> Relocaliser::find(const RgbdPyramid& live,
                                                const std::vector<ExpectedPlace>& places,
                                                const std::deque<KeyframeViewPtr>& views,
                                                const Judge& is_doubtless) {
  const Live image{live, TrackingReference(live, tracking_), is_doubtless};
  for (const ExpectedPlace& place : places) {
    if (std::optional<Relocalisation> found = alignWith(place, image)) return found;
  }
  for (const ExpectedPlace& place : findAlike(live, views)) {
    if (std::optional<Relocalisation> found = alignWith(place, image)) return found;
  }
  return std::nullopt;
}

}  // namespace planecloud

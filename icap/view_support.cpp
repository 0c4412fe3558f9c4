// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/icap/view_support.h"

#include <algorithm>

#include "planecloud_slam/icap/visibility.h"
#include "planecloud_slam/plane_fit/se3.h"

namespace planecloud {
namespace {

constexpr double kEnoughShare = 0.3;      // of a view in the other one: its support counts in full
constexpr double kSlideStep = 0.02;       // [m, rad]
constexpr int kSlideSteps = 4;            // of twice that length either way
constexpr int kSlides = 3;                // one after the other at most
constexpr double kSlideSupport = 0.0025;  // difference of support worth one nat of likelihood
constexpr double kWellKnown = 6000.0;     // information that leaves nothing to support [1/m^2]

/// What the planes know along a unit twist beyond what the noise of their normals feigns.
double informationAlong(const Vector6d& direction, const PlaneNormalEquations& system) {
  const double curvature = direction.dot((system.hessian - system.noise) * direction);
  return std::max(0.0, curvature) / kCorrelatedResiduals;
}

/// The way along `direction` [m, rad] that support and planes together like best; 0: stay.
double bestWay(const PlaneSetPair& pair, const Eigen::Isometry3d& T_target_source,
               const Vector6d& direction, double information, const VisibilityOptions& options) {
  const double here = viewSupport(pair, T_target_source, options);
  double best_way = 0.0;
  double best_gain = kLeastSupportGain;
  const auto consider = [&](double way) {
    const double there = viewSupport(pair, T_target_source * expSe3(way * direction), options);
    const double gained = supportGain(there, here) - 0.5 * way * way * information;
    if (gained <= best_gain) return;
    best_gain = gained;
    best_way = way;
  };
  for (int i = 1; i <= kSlideSteps; ++i) {
    for (const double side : {-2.0, 2.0}) consider(side * i * kSlideStep);
  }
  if (best_way != 0.0) {
    const double middle = best_way;
    for (const double side : {-1.0, 1.0}) consider(middle + side * kSlideStep);
  }
  return best_way;
}

}  // namespace

double viewSupport(const PlaneSetPair& pair, const Eigen::Isometry3d& T_target_source,
                   const VisibilityOptions& options) {
  const VisibilityReport forth =
      checkVisibility(pair.target, pair.source, T_target_source, options);
  const VisibilityReport back =
      checkVisibility(pair.source, pair.target, T_target_source.inverse(), options);
  const double share = 0.5 * (forth.viewShare() + back.viewShare());
  return 0.5 * (forth.overlap() + back.overlap()) * std::min(1.0, share / kEnoughShare);
}

double supportGain(double support, double other_support) {
  return (support - other_support) / kSlideSupport;
}

void slideToSupport(const PlaneSetPair& pair, const IcapOptions& options,
                    AlignmentProgress& progress) {
  for (int slide = 0; slide < kSlides && progress.enough; ++slide) {
    const Vector6d direction = leastObserved(progress.system);
    const double information = informationAlong(direction, progress.system);
    if (information > kWellKnown) return;
    const double way =
        bestWay(pair, progress.T_target_source, direction, information, options.visibility);
    if (way == 0.0) return;
    progress.T_target_source = progress.T_target_source * expSe3(way * direction);
    settle(pair, options, progress);
  }
}

}  // namespace planecloud

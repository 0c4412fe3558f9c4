// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/backend_node/closure_verifier.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "planecloud_slam/backend_node/drift_model.h"
#include "planecloud_slam/icap/visibility.h"

namespace planecloud {
namespace {

/// From this far off the alignment finds home (ALGORITHMS 5.6).
constexpr double kBasinTranslation = 0.3;  // [m]
constexpr double kBasinRotation = 0.26;    // [rad]

/// How far apart views are that look alike to the appearance descriptor.
constexpr double kAlikeTranslation = 0.5;  // [m]
constexpr double kAlikeRotation = 0.3;     // [rad]

/// Answers further apart than this are different ones.
constexpr double kDifferentTranslation = 0.15;  // [m]
constexpr double kDifferentRotation = 0.1;      // [rad]

/// A corridor leaves one direction unobserved, a single wall three.
constexpr std::size_t kMostUnobserved = 1;

Eigen::Isometry3d shifted(const Eigen::Isometry3d& T, double right, double forward, double turn) {
  const Eigen::AngleAxisd yaw(turn, Eigen::Vector3d::UnitY());
  return T * Eigen::Translation3d(right, 0.0, forward) * yaw;
}

/// Whether two answers differ in a direction that the first one observes.
bool differ(const IcapResult& a, const IcapResult& b) {
  Vector6d error = logSe3(a.T_target_source.inverse() * b.T_target_source);
  for (const Vector6d& direction : a.unobserved) error -= direction * direction.dot(error);
  return error.head<3>().norm() > kDifferentTranslation ||
         error.tail<3>().norm() > kDifferentRotation;
}

}  // namespace

std::string toString(ClosureVerdict verdict) {
  switch (verdict) {
    case ClosureVerdict::kAccepted:
      return "accepted";
    case ClosureVerdict::kTooFewPlanes:
      return "too_few_planes";
    case ClosureVerdict::kDiverged:
      return "diverged";
    case ClosureVerdict::kUninformative:
      return "uninformative";
    case ClosureVerdict::kLargeResidual:
      return "large_residual";
    case ClosureVerdict::kLittleOverlap:
      return "little_overlap";
    case ClosureVerdict::kSeenThrough:
      return "seen_through";
    case ClosureVerdict::kInconsistent:
      return "inconsistent_with_odometry";
    case ClosureVerdict::kAmbiguous:
      return "ambiguous";
  }
  return "unknown";
}

std::vector<Eigen::Isometry3d> alignmentStarts(const RelativePoseGuess& guess) {
  double shift = kAlikeTranslation;
  double turn = kAlikeRotation;
  if (guess.covariance) {
    // Two standard deviations of one axis, as far as one more basin reaches.
    const double sigma_t = std::sqrt(guess.covariance->topLeftCorner<3, 3>().trace() / 3.0);
    const double sigma_r = std::sqrt(guess.covariance->bottomRightCorner<3, 3>().trace() / 3.0);
    shift = std::min(2.0 * sigma_t, 2.0 * kBasinTranslation);
    turn = std::min(2.0 * sigma_r, 2.0 * kBasinRotation);
  }
  const Eigen::Isometry3d& centre = guess.T_target_source;
  std::vector<Eigen::Isometry3d> starts{centre};
  if (shift > kBasinTranslation) {
    for (const double side : {-shift, shift}) {
      starts.push_back(shifted(centre, side, 0.0, 0.0));
      starts.push_back(shifted(centre, 0.0, side, 0.0));
    }
  }
  if (turn > kBasinRotation) {
    for (const double side : {-turn, turn}) starts.push_back(shifted(centre, 0.0, 0.0, side));
  }
  return starts;
}

ClosureVerdict ClosureVerifier::judge(const ClosureCheck& check, double view,
                                      const Limits& limits) const {
  const IcapResult& result = check.alignment;
  if (result.status == IcapStatus::kTooFewPlanes) return ClosureVerdict::kTooFewPlanes;
  if (result.status == IcapStatus::kDiverged) return ClosureVerdict::kDiverged;
  if (result.unobserved.size() > kMostUnobserved) return ClosureVerdict::kUninformative;
  if (result.rms_algebraic_error > options_.max_residual) return ClosureVerdict::kLargeResidual;
  if (check.overlap < limits.min_overlap || view < options_.min_view) {
    return ClosureVerdict::kLittleOverlap;
  }
  if (check.seen_through > limits.max_seen_through) return ClosureVerdict::kSeenThrough;
  return ClosureVerdict::kAccepted;
}

ClosureCheck ClosureVerifier::align(const PlaneSet& target, const PlaneSet& source,
                                    const Start& start, const Limits& limits) const {
  IcapOptions options = icap_;
  options.restarts = options.restarts && start.restarts;
  ClosureCheck check;
  check.alignment = icap(target, source, start.T_target_source, options);
  const Eigen::Isometry3d& T_target_source = check.alignment.T_target_source;
  const VisibilityReport forth = checkVisibility(target, source, T_target_source, icap_.visibility);
  const VisibilityReport back =
      checkVisibility(source, target, T_target_source.inverse(), icap_.visibility);
  check.overlap = std::min(forth.overlap(), back.overlap());
  check.seen_through = std::max(forth.seenThroughShare(), back.seenThroughShare());
  check.verdict = judge(check, std::min(forth.viewShare(), back.viewShare()), limits);
  return check;
}

bool ClosureVerifier::agrees(const IcapResult& result, const RelativePoseGuess& guess) const {
  if (!guess.covariance) return true;
  const Matrix6d covariance = *guess.covariance + measurementCovariance(result.information);
  const Vector6d error = logSe3(result.T_target_source.inverse() * guess.T_target_source);
  return squaredMahalanobis(error, covariance) <= options_.max_inconsistency;
}

ClosureCheck ClosureVerifier::verify(const PlaneSet& target, const PlaneSet& source,
                                     const RelativePoseGuess& guess) const {
  const Limits limits = guess.covariance ? Limits{options_.min_overlap, options_.max_seen_through}
                                         : Limits{options_.unlocated_min_overlap,
                                                  options_.unlocated_max_seen_through};
  std::vector<ClosureCheck> checks;
  for (const Eigen::Isometry3d& start : alignmentStarts(guess)) {
    // The other starts are what restarts of theirs would be.
    ClosureCheck check = align(target, source, {start, checks.empty()}, limits);
    if (check.verdict == ClosureVerdict::kAccepted && !agrees(check.alignment, guess)) {
      check.verdict = ClosureVerdict::kInconsistent;
    }
    checks.push_back(std::move(check));
  }
  const auto support = [](const ClosureCheck& check) {
    return std::pair(check.verdict == ClosureVerdict::kAccepted, check.overlap);
  };
  ClosureCheck best = *std::max_element(
      checks.begin(), checks.end(),
      [&](const ClosureCheck& a, const ClosureCheck& b) { return support(a) < support(b); });
  // The first start is the best guess: when all fail, what became of it tells most.
  if (best.verdict != ClosureVerdict::kAccepted) return checks.front();
  for (const ClosureCheck& other : checks) {
    const bool rival = other.verdict == ClosureVerdict::kAccepted &&
                       other.overlap >= best.overlap - options_.ambiguity_margin;
    if (rival && differ(best.alignment, other.alignment)) {
      best.verdict = ClosureVerdict::kAmbiguous;
      break;
    }
  }
  return best;
}

}  // namespace planecloud

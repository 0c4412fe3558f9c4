// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/icap/robust_alignment.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "planecloud_slam/icap/visibility.h"
#include "planecloud_slam/plane_fit/se3.h"

namespace planecloud {
namespace {

constexpr double kGateShrink = 0.7;       // of the gates from one iteration to the next
constexpr double kSettledStep = 2e-4;     // norm of a twist that counts as standing still [m, rad]
constexpr double kScoutedStep = 1e-3;     // likewise while a sample leads the way
constexpr int kPolishingIterations = 10;  // of those there are, at least
constexpr double kFineDistance = 0.12;    // gate at which the small pieces take over [m]
// Of the noise's curvature: what the iterations follow. Less than `observability`, for on the way
// even a poorly known direction leads nearer; what was not observed in the end is taken back.
constexpr double kFollowed = 0.3;
constexpr int kRestoringIterations = 4;
// Pieces that find the way with the fine gates; all of them have their say about the end of it.
constexpr std::size_t kScouts = 500;
// An answer with less support is tried again from starts this far around the guess.
constexpr double kSureSupport = 0.97;
constexpr double kLostSupport = 0.93;
constexpr double kDirectDistance = 0.25;
constexpr double kRestartTurn = 0.21;  // [rad]
// Along the least known direction the answer slides to where the views support each other most.
constexpr double kSlideStep = 0.02;       // [m, rad]
constexpr int kSlideSteps = 4;            // of twice that length either way
constexpr double kSlideSupport = 0.0025;  // difference of support worth one nat of likelihood
constexpr double kLeastGain = 2.0;        // [nat]
constexpr double kWellKnown = 6000.0;     // information that leaves nothing to support [1/m^2]

/// Two plane clouds on their way to each other.
struct Pair {
  const PlaneSet& target;
  const PlaneSet& source;
};

/// The annealing of one alignment.
struct Schedule {
  MatchGates gates;
  double kernel_width = 0.0;
  bool coarse = false;
  std::size_t coarse_count = 0;  ///< of coarse pieces
  bool last = false;             ///< the gates are at their final values
  bool last_stage = false;       ///< only what is observed moves
  std::size_t fine_count = std::numeric_limits<std::size_t>::max();  ///< of fine pieces
};

Schedule scheduleOf(int iteration, const IcapOptions& options) {
  const double shrink = std::pow(kGateShrink, iteration);
  Schedule schedule;
  schedule.gates.distance = std::max(options.final_distance, options.initial_distance * shrink);
  schedule.gates.angle = std::max(options.final_angle, options.initial_angle * shrink);
  schedule.last = schedule.gates.distance <= options.final_distance &&
                  schedule.gates.angle <= options.final_angle;
  schedule.coarse = schedule.gates.distance > kFineDistance;
  schedule.gates.normal_length =
      schedule.coarse ? options.coarse_normal_length : options.fine_normal_length;
  schedule.kernel_width = options.kernel_width * schedule.gates.distance / options.final_distance;
  return schedule;
}

/// One step of Gauss-Newton within the directions that stand out from noise.
void iterate(const Pair& pair, const Schedule& schedule, const IcapOptions& options,
             AlignmentProgress& progress) {
  progress.matches = schedule.coarse
                         ? matchAnywhere(pair.target, pair.source, progress.T_target_source,
                                         schedule.gates, schedule.coarse_count)
                         : matchInView(pair.target, pair.source, progress.T_target_source,
                                       schedule.gates, schedule.fine_count);
  progress.enough = progress.matches.size() >= static_cast<std::size_t>(options.min_matches);
  if (!progress.enough) return;
  progress.system = buildNormalEquations(progress.matches, progress.T_target_source,
                                         schedule.kernel_width, options);
  progress.observability = analyseObservability(progress.system, options.observability);
  const Vector6d step = solveObserved(
      progress.system,
      schedule.last_stage
          ? progress.observability
          : analyseObservability(progress.system, std::min(kFollowed, options.observability)));
  progress.T_target_source = progress.T_target_source * expSe3(step);
  progress.last_step = step.norm();
  ++progress.iterations;
}

void runCoarse(const Pair& pair, std::size_t pieces, const IcapOptions& options,
               AlignmentProgress& progress) {
  for (int i = 0; i < options.max_iterations; ++i) {
    Schedule schedule = scheduleOf(i, options);
    if (!schedule.coarse) break;
    schedule.coarse_count = pieces;
    iterate(pair, schedule, options, progress);
    if (!progress.enough) break;
  }
}

/// Begins at a gate of at most `gate` [m]; by a sample of the fine pieces.
void runFine(const Pair& pair, double gate, const IcapOptions& options,
             AlignmentProgress& progress) {
  int first = 0;
  while (first < options.max_iterations && scheduleOf(first, options).gates.distance > gate) {
    ++first;
  }
  const int most = options.max_iterations - kPolishingIterations;
  for (int i = first; progress.iterations < most; ++i) {
    Schedule schedule = scheduleOf(i, options);
    schedule.coarse = false;
    schedule.gates.normal_length = options.fine_normal_length;
    schedule.fine_count = kScouts;
    iterate(pair, schedule, options, progress);
    if (!progress.enough || (schedule.last && progress.last_step < kScoutedStep)) break;
  }
}

/// Settles the answer by all pieces.
void polish(const Pair& pair, const IcapOptions& options, AlignmentProgress& progress) {
  if (!progress.enough) return;
  const Schedule schedule = scheduleOf(options.max_iterations, options);
  while (progress.iterations < options.max_iterations) {
    iterate(pair, schedule, options, progress);
    if (!progress.enough || progress.last_step < kSettledStep) break;
  }
}

/// Takes the answer back to the guess in the directions that turned out unobserved.
void restoreUnobserved(const Pair& pair, const Eigen::Isometry3d& T_target_source_guess,
                       const IcapOptions& options, AlignmentProgress& progress) {
  Schedule schedule = scheduleOf(options.max_iterations, options);
  schedule.last_stage = true;
  for (int i = 0; i < kRestoringIterations && progress.enough; ++i) {
    const auto& dark = progress.observability.unobserved;
    if (dark.cols() == 0) break;
    const Vector6d back = logSe3(progress.T_target_source.inverse() * T_target_source_guess);
    progress.T_target_source = progress.T_target_source * expSe3(dark * (dark.transpose() * back));
    iterate(pair, schedule, options, progress);
  }
}

/// Share of what each view should see of the other that it does see, mean of both ways.
double supportOf(const Pair& pair, const Eigen::Isometry3d& T, const IcapOptions& options) {
  return 0.5 *
         (checkVisibility(pair.target, pair.source, T, options.visibility).overlap() +
          checkVisibility(pair.source, pair.target, T.inverse(), options.visibility).overlap());
}

void measureSupport(const Pair& pair, const IcapOptions& options, AlignmentProgress& progress) {
  progress.support = progress.enough ? supportOf(pair, progress.T_target_source, options) : 0.0;
}

/// The edges of surfaces tell what their planes do not: past an edge one view sees through what the
/// other saw. Slides along the direction that the planes know least, for the most likely support.
void slideToSupport(const Pair& pair, const IcapOptions& options, AlignmentProgress& progress) {
  if (!progress.enough) return;
  const Vector6d direction = leastObserved(progress.system);
  const double information =
      direction.dot(progress.system.hessian * direction) / kCorrelatedResiduals;
  if (information > kWellKnown) return;
  const double here = supportOf(pair, progress.T_target_source, options);
  const auto gain = [&](double way) {
    const Eigen::Isometry3d there = progress.T_target_source * expSe3(way * direction);
    return (supportOf(pair, there, options) - here) / kSlideSupport - 0.5 * way * way * information;
  };
  double best_way = 0.0;
  double best_gain = kLeastGain;
  const auto consider = [&](double way) {
    const double gained = gain(way);
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
  progress.T_target_source = progress.T_target_source * expSe3(best_way * direction);
}

/// The guess turned either way about each axis of the source's camera.
std::vector<Eigen::Isometry3d> startsAround(const Eigen::Isometry3d& T_target_source_guess) {
  std::vector<Eigen::Isometry3d> starts;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double turn : {-kRestartTurn, kRestartTurn}) {
      starts.push_back(T_target_source_guess *
                       Eigen::AngleAxisd(turn, Eigen::Vector3d::Unit(axis)));
    }
  }
  return starts;
}

/// Where the coarse stage finds most support from the starts around the guess.
AlignmentProgress bestRestart(const Pair& pair, const Eigen::Isometry3d& T_target_source_guess,
                              const IcapOptions& options) {
  const std::size_t pieces = static_cast<std::size_t>(options.coarse_patches) / 2;
  AlignmentProgress best;
  for (const Eigen::Isometry3d& start : startsAround(T_target_source_guess)) {
    AlignmentProgress progress;
    progress.T_target_source = start;
    runCoarse(pair, pieces, options, progress);
    measureSupport(pair, options, progress);
    if (progress.support > best.support) best = progress;
  }
  return best;
}

/// The answer from one start.
AlignmentProgress alignFrom(const Pair& pair, AlignmentProgress start, double gate,
                            const IcapOptions& options) {
  runFine(pair, gate, options, start);
  measureSupport(pair, options, start);
  return start;
}

void keepBetter(AlignmentProgress other, AlignmentProgress& progress) {
  if (other.support > progress.support) progress = std::move(other);
}

}  // namespace

AlignmentProgress alignRobustly(const PlaneSet& target, const PlaneSet& source,
                                const Eigen::Isometry3d& T_target_source_guess,
                                const IcapOptions& options) {
  const Pair pair{target, source};
  AlignmentProgress guess;
  guess.T_target_source = T_target_source_guess;
  AlignmentProgress progress = guess;
  runCoarse(pair, static_cast<std::size_t>(options.coarse_patches), options, progress);
  progress = alignFrom(pair, std::move(progress), kFineDistance, options);
  if (progress.support < kSureSupport) {
    keepBetter(alignFrom(pair, guess, kDirectDistance, options), progress);
  }
  if (options.restarts && progress.support < kLostSupport) {
    AlignmentProgress again = bestRestart(pair, T_target_source_guess, options);
    if (again.enough) {
      keepBetter(alignFrom(pair, std::move(again), kFineDistance, options), progress);
    }
  }
  polish(pair, options, progress);
  restoreUnobserved(pair, T_target_source_guess, options, progress);
  slideToSupport(pair, options, progress);
  return progress;
}

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/icap/alignment_steps.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "planecloud_slam/plane_fit/se3.h"

namespace planecloud {
namespace {

constexpr double kGateShrink = 0.6;       // of the gates from one iteration to the next
constexpr double kSettledStep = 2e-4;     // norm of a twist that counts as standing still [m, rad]
constexpr double kScoutedStep = 1e-3;     // likewise while a sample leads the way
constexpr int kPolishingIterations = 10;  // of those there are, at least
constexpr double kFineDistance = 0.12;    // gate at which the small pieces take over [m]
// Of the noise's curvature: the directions coarse iterations move in, if not fewer. Fine ones move
// in those that count as observed: along weaker ones the errors of the normals push as hard as the
// planes do, and an answer that follows drifts away with its matches, decimetres in a few steps;
// how far it is along those the edges tell (slideToSupport).
constexpr double kFollowedByCoarse = 1.0;
constexpr int kRestoringIterations = 4;
constexpr int kSettlingIterations = 2;
// Pieces that find the way with the fine gates; all of them have their say about the end of it.
constexpr std::size_t kScouts = 500;

/// The annealing of one alignment.
struct Schedule {
  MatchGates gates;
  double kernel_width = 0.0;       ///< of what is observed, and how well
  double step_kernel_width = 0.0;  ///< of the way there
  bool coarse = false;
  std::size_t count = std::numeric_limits<std::size_t>::max();  ///< of source pieces
  double followed = 0.0;  ///< of the noise's curvature: directions that move
  bool last = false;      ///< the gates are at their final values
};

Schedule scheduleOf(int iteration, const IcapOptions& options) {
  const double shrink = std::pow(kGateShrink, iteration);
  Schedule schedule;
  schedule.gates.distance = std::max(options.final_distance, options.initial_distance * shrink);
  schedule.gates.angle = std::max(options.final_angle, options.initial_angle * shrink);
  schedule.last = schedule.gates.distance <= options.final_distance &&
                  schedule.gates.angle <= options.final_angle;
  schedule.gates.normal_length = options.fine_normal_length;
  schedule.followed = options.observability;
  schedule.kernel_width = options.kernel_width * schedule.gates.distance / options.final_distance;
  schedule.step_kernel_width = schedule.kernel_width;
  return schedule;
}

Schedule finalSchedule(const IcapOptions& options) {
  Schedule schedule = scheduleOf(options.max_iterations, options);
  schedule.step_kernel_width = options.final_kernel_width;
  return schedule;
}

/// One step of Gauss-Newton within the directions that stand out from noise.
void iterate(const PlaneSetPair& pair, const Schedule& schedule, const IcapOptions& options,
             AlignmentProgress& progress) {
  const auto match = schedule.coarse ? matchAnywhere : matchInView;
  progress.matches =
      match(pair.target, pair.source, progress.T_target_source, schedule.gates, schedule.count);
  progress.enough = progress.matches.size() >= static_cast<std::size_t>(options.min_matches);
  if (!progress.enough) return;
  const auto systemOf = [&](double kernel_width) {
    return buildNormalEquations(progress.matches, progress.T_target_source, kernel_width, options);
  };
  progress.system = systemOf(schedule.kernel_width);
  progress.observability = analyseObservability(progress.system, options.observability);
  const Observability moving = schedule.followed == options.observability
                                   ? progress.observability
                                   : analyseObservability(progress.system, schedule.followed);
  const bool is_wider = schedule.step_kernel_width != schedule.kernel_width;
  const Vector6d step =
      solveObserved(is_wider ? systemOf(schedule.step_kernel_width) : progress.system, moving);
  progress.T_target_source = progress.T_target_source * expSe3(step);
  progress.last_step = step.norm();
  ++progress.iterations;
}

}  // namespace

void runCoarse(const PlaneSetPair& pair, std::size_t pieces, const IcapOptions& options,
               AlignmentProgress& progress) {
  for (int i = 0; i < options.max_iterations; ++i) {
    Schedule schedule = scheduleOf(i, options);
    if (schedule.gates.distance <= kFineDistance) break;
    schedule.coarse = true;
    schedule.gates.normal_length = options.coarse_normal_length;
    schedule.followed = std::min(kFollowedByCoarse, options.observability);
    schedule.count = pieces;
    iterate(pair, schedule, options, progress);
    if (!progress.enough) break;
  }
}

void runFine(const PlaneSetPair& pair, double gate, const IcapOptions& options,
             AlignmentProgress& progress) {
  int first = 0;
  while (first < options.max_iterations && scheduleOf(first, options).gates.distance > gate) {
    ++first;
  }
  const int most = options.max_iterations - kPolishingIterations;
  for (int i = first; progress.iterations < most; ++i) {
    Schedule schedule = scheduleOf(i, options);
    schedule.count = kScouts;
    iterate(pair, schedule, options, progress);
    if (!progress.enough || (schedule.last && progress.last_step < kScoutedStep)) break;
  }
}

void polish(const PlaneSetPair& pair, const IcapOptions& options, AlignmentProgress& progress) {
  if (!progress.enough) return;
  const Schedule schedule = finalSchedule(options);
  while (progress.iterations < options.max_iterations) {
    iterate(pair, schedule, options, progress);
    if (!progress.enough || progress.last_step < kSettledStep) break;
  }
}

void settle(const PlaneSetPair& pair, const IcapOptions& options, AlignmentProgress& progress) {
  const Schedule schedule = finalSchedule(options);
  for (int i = 0; i < kSettlingIterations && progress.enough; ++i) {
    iterate(pair, schedule, options, progress);
  }
}

void restoreUnobserved(const PlaneSetPair& pair, const Eigen::Isometry3d& T_target_source_guess,
                       const IcapOptions& options, AlignmentProgress& progress) {
  const Schedule schedule = finalSchedule(options);
  for (int i = 0; i < kRestoringIterations && progress.enough; ++i) {
    const auto& dark = progress.observability.unobserved;
    if (dark.cols() == 0) break;
    const Vector6d back = logSe3(progress.T_target_source.inverse() * T_target_source_guess);
    progress.T_target_source = progress.T_target_source * expSe3(dark * (dark.transpose() * back));
    iterate(pair, schedule, options, progress);
  }
}

}  // namespace planecloud

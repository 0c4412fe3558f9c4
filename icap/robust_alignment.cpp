// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/icap/robust_alignment.h"

#include <cstddef>
#include <utility>
#include <vector>

#include "planecloud_slam/icap/view_support.h"

namespace planecloud {
namespace {

// An answer with less support is looked for elsewhere, too: right ones are at 0.9 to 1, few of the
// wrong ones reach that.
constexpr double kSureSupport = 0.9;
constexpr double kScoutedGate = 0.12;  // of the fine pieces after the coarse ones [m]
constexpr double kDirectGate = 0.25;   // of the fine pieces from the guess [m]
constexpr int kRestartRounds = 4;
constexpr double kRestartTurn = 0.3;    // [rad]
constexpr double kRestartShift = 0.25;  // [m]

void measureSupport(const PlaneSetPair& pair, const IcapOptions& options,
                    AlignmentProgress& progress) {
  progress.support =
      progress.enough ? viewSupport(pair, progress.T_target_source, options.visibility) : 0.0;
}

/// The pose turned either way about each axis of the source's camera.
std::vector<Eigen::Isometry3d> turned(const Eigen::Isometry3d& T_target_source) {
  std::vector<Eigen::Isometry3d> starts;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double turn : {-kRestartTurn, kRestartTurn}) {
      starts.push_back(T_target_source * Eigen::AngleAxisd(turn, Eigen::Vector3d::Unit(axis)));
    }
  }
  return starts;
}

/// The pose shifted either way along each axis of the source's camera, and itself.
std::vector<Eigen::Isometry3d> shifted(const Eigen::Isometry3d& T_target_source) {
  std::vector<Eigen::Isometry3d> starts;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double shift : {-kRestartShift, kRestartShift}) {
      starts.push_back(T_target_source * Eigen::Translation3d(shift * Eigen::Vector3d::Unit(axis)));
    }
  }
  starts.push_back(T_target_source);
  return starts;
}

/// Where to look in a round. Lost answers are turned wrongly, or rightly but taken along by
/// surfaces that look alike: other turns and, with the turn found, other places take turns.
std::vector<Eigen::Isometry3d> startsOf(int round, const Eigen::Isometry3d& T_target_source_guess,
                                        const AlignmentProgress& progress) {
  if (round == 0 || !progress.enough) return turned(T_target_source_guess);
  if (round % 2 == 0) return turned(progress.T_target_source);
  Eigen::Isometry3d T_target_source = T_target_source_guess;
  T_target_source.linear() = progress.T_target_source.linear();
  return shifted(T_target_source);
}

/// Where the coarse stage finds most support, or the first that is sure.
AlignmentProgress bestCoarse(const PlaneSetPair& pair, const std::vector<Eigen::Isometry3d>& starts,
                             const IcapOptions& options) {
  const std::size_t pieces = static_cast<std::size_t>(options.coarse_patches) / 2;
  AlignmentProgress best;
  for (const Eigen::Isometry3d& start : starts) {
    AlignmentProgress progress;
    progress.T_target_source = start;
    runCoarse(pair, pieces, options, progress);
    measureSupport(pair, options, progress);
    if (progress.support > best.support) best = std::move(progress);
    if (best.support > kSureSupport) break;
  }
  return best;
}

/// Goes on by fine pieces; keeps what comes of it when it has more support than `progress`.
void tryFine(const PlaneSetPair& pair, AlignmentProgress start, double gate,
             const IcapOptions& options, AlignmentProgress& progress) {
  runFine(pair, gate, options, start);
  measureSupport(pair, options, start);
  if (start.support > progress.support || !progress.enough) progress = std::move(start);
}

/// The answer before the last touch: by way of coarse pieces, and elsewhere while support is poor.
AlignmentProgress search(const PlaneSetPair& pair, const Eigen::Isometry3d& T_target_source_guess,
                         const IcapOptions& options) {
  AlignmentProgress guess;
  guess.T_target_source = T_target_source_guess;
  AlignmentProgress coarse = guess;
  runCoarse(pair, static_cast<std::size_t>(options.coarse_patches), options, coarse);
  AlignmentProgress progress = guess;
  tryFine(pair, std::move(coarse), kScoutedGate, options, progress);
  if (progress.support < kSureSupport) tryFine(pair, guess, kDirectGate, options, progress);
  if (!options.restarts) return progress;
  for (int round = 0; round < kRestartRounds && progress.support < kSureSupport; ++round) {
    AlignmentProgress again =
        bestCoarse(pair, startsOf(round, T_target_source_guess, progress), options);
    if (again.enough) tryFine(pair, std::move(again), kScoutedGate, options, progress);
  }
  return progress;
}

/// Where nothing is observed the guess is as good as any answer, unless the edges like it less.
void keepGuessWhereUnobserved(const PlaneSetPair& pair,
                              const Eigen::Isometry3d& T_target_source_guess,
                              const IcapOptions& options, AlignmentProgress& progress) {
  if (!progress.enough || progress.observability.unobserved.cols() == 0) return;
  AlignmentProgress kept = progress;
  restoreUnobserved(pair, T_target_source_guess, options, kept);
  slideToSupport(pair, options, kept);
  if (!kept.enough) return;
  measureSupport(pair, options, kept);
  measureSupport(pair, options, progress);
  if (supportGain(progress.support, kept.support) <= kLeastSupportGain) progress = std::move(kept);
}

}  // namespace

AlignmentProgress alignRobustly(const PlaneSet& target, const PlaneSet& source,
                                const Eigen::Isometry3d& T_target_source_guess,
                                const IcapOptions& options) {
  const PlaneSetPair pair{target, source};
  AlignmentProgress progress = search(pair, T_target_source_guess, options);
  polish(pair, options, progress);
  slideToSupport(pair, options, progress);
  keepGuessWhereUnobserved(pair, T_target_source_guess, options, progress);
  return progress;
}

}  // namespace planecloud

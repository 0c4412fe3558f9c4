// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "planecloud_slam/backend_node/loop_closure_options.h"
#include "planecloud_slam/icap/icap.h"

namespace planecloud {

/// Why an aligned pair is no closure; `kAccepted` when it is one.
enum class ClosureVerdict {
  kAccepted,
  kTooFewPlanes,  ///< nothing to align
  kDiverged,
  kUninformative,  ///< more than one direction unobserved
  kLargeResidual,
  kLittleOverlap,  ///< tiles that should be visible are not there
  kSeenThrough,    ///< tiles lie where the other keyframe saw free space
  kInconsistent,   ///< odometry cannot have drifted that far
  kAmbiguous,      ///< two different answers are about as well supported
};

/// Snake-case word for statistics.
[[nodiscard]] std::string toString(ClosureVerdict verdict);

/// What is known of a pair beforehand.
struct RelativePoseGuess {
  Eigen::Isometry3d T_target_source = Eigen::Isometry3d::Identity();
  /// At the source, see se3.h [m^2, rad^2]. None: the two only look alike.
  std::optional<Matrix6d> covariance;
};

/// An answer to how two keyframes lie to each other, and whether it holds.
struct ClosureCheck {
  ClosureVerdict verdict = ClosureVerdict::kTooFewPlanes;
  IcapResult alignment;
  double overlap = 0.0;       ///< the smaller of both ways, [0, 1]
  double seen_through = 0.0;  ///< the larger of both ways, [0, 1]
};

/// Decides whether two keyframes show the same place (ALGORITHMS 6.2): alignment, residual, overlap
/// of what should be visible, free space, odometry, a single answer. Precision goes first.
class ClosureVerifier {
 public:
  ClosureVerifier(const ClosureVerificationOptions& options, const IcapOptions& icap)
      : options_(options), icap_(icap) {}

  /// Aligns from several starts and returns the best supported answer. The starts spread over the
  /// guess's uncertainty; without one, over what similar views allow.
  [[nodiscard]] ClosureCheck verify(const PlaneSet& target, const PlaneSet& source,
                                    const RelativePoseGuess& guess) const;

 private:
  /// Limits of overlap and free space.
  struct Limits {
    double min_overlap = 0.0;
    double max_seen_through = 0.0;
  };

  /// Where an alignment begins, and whether it may begin again around it.
  struct Start {
    Eigen::Isometry3d T_target_source = Eigen::Isometry3d::Identity();
    bool restarts = true;
  };

  [[nodiscard]] ClosureCheck align(const PlaneSet& target, const PlaneSet& source,
                                   const Start& start, const Limits& limits) const;
  [[nodiscard]] ClosureVerdict judge(const ClosureCheck& check, double view,
                                     const Limits& limits) const;
  [[nodiscard]] bool agrees(const IcapResult& result, const RelativePoseGuess& guess) const;

  ClosureVerificationOptions options_;
  IcapOptions icap_;
};

/// Starts around a guess: the guess first, then shifts along and across the view and turns about
/// the camera's vertical, no closer to each other than the basin of the alignment.
[[nodiscard]] std::vector<Eigen::Isometry3d> alignmentStarts(const RelativePoseGuess& guess);

}  // namespace planecloud

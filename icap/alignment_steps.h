// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

#include "planecloud_slam/icap/icap_options.h"
#include "planecloud_slam/icap/patch_matcher.h"
#include "planecloud_slam/icap/plane_normal_equations.h"
#include "planecloud_slam/icap/plane_set.h"

/// The stages of Gauss-Newton that alignRobustly is made of.
namespace planecloud {

/// Two plane clouds on their way to each other.
struct PlaneSetPair {
  const PlaneSet& target;
  const PlaneSet& source;
};

/// Where the iterations of an alignment stand.
struct AlignmentProgress {
  Eigen::Isometry3d T_target_source = Eigen::Isometry3d::Identity();
  std::vector<PatchMatch> matches;  ///< of the last iteration
  PlaneNormalEquations system;      ///< likewise
  Observability observability;      ///< of `system`
  double last_step = 0.0;           ///< norm of the last twist [m, rad]
  double support = 0.0;             ///< see viewSupport
  int iterations = 0;
  bool enough = false;  ///< matches for a transform
};

/// Coarse pieces, matched wherever they are, from the widest gates down; the first `pieces` of the
/// source take part.
void runCoarse(const PlaneSetPair& pair, std::size_t pieces, const IcapOptions& options,
               AlignmentProgress& progress);

/// A sample of the fine pieces, matched in view, from a gate of at most `gate` [m] down.
void runFine(const PlaneSetPair& pair, double gate, const IcapOptions& options,
             AlignmentProgress& progress);

/// All fine pieces with the final gates until the answer stands still.
void polish(const PlaneSetPair& pair, const IcapOptions& options, AlignmentProgress& progress);

/// Follows with what is well known after the answer was moved along what is not.
void settle(const PlaneSetPair& pair, const IcapOptions& options, AlignmentProgress& progress);

/// Takes the answer back to the guess in the directions that turned out unobserved.
void restoreUnobserved(const PlaneSetPair& pair, const Eigen::Isometry3d& T_target_source_guess,
                       const IcapOptions& options, AlignmentProgress& progress);

}  // namespace planecloud

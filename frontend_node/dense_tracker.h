// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "planecloud_slam/frontend_node/alignment_kernel.h"
#include "planecloud_slam/frontend_node/dense_tracker_options.h"
#include "planecloud_slam/frontend_node/planar_motion.h"
#include "planecloud_slam/frontend_node/rgbd_pyramid.h"
#include "planecloud_slam/frontend_node/tracking_reference.h"
#include "planecloud_slam/plane_fit/se3.h"

namespace planecloud {

/// Where an alignment may start.
struct AlignmentStart {
  /// Candidates for T_reference_current, at least one: the search starts at the one that fits best
  /// on the coarsest level; of six or more, the best six are followed there. The first is where
  /// the motion prior, if any, pulls to.
  std::vector<Eigen::Isometry3d> T_reference_current;
  Brightness brightness;
};

enum class AlignmentStatus {
  kConverged,
  kNotConverged,  ///< the finest level used up its iterations
  kTooFewPoints,  ///< the images share too little to compare
  kDegenerate,    ///< the normal equations have no unique solution
};

/// A relative pose found by dense alignment, and how good it is.
struct Alignment {
  AlignmentStatus status = AlignmentStatus::kTooFewPoints;
  Eigen::Isometry3d T_reference_current = Eigen::Isometry3d::Identity();
  /// Of T_reference_current, errors of neighbouring pixels correlated (se3.h convention).
  Matrix6d information = Matrix6d::Zero();
  /// The normal matrix at convergence, pixels independent: overconfident, but its entropy is
  /// smooth from frame to frame (same convention).
  Matrix6d normal_matrix = Matrix6d::Zero();
  Brightness brightness;
  ResidualScale scale;
  double overlap = 0.0;  ///< share of the reference's points seen on valid depth, [0, 1]
  double inliers = 0.0;  ///< share of these whose depth agrees to 5 %, [0, 1]
  int iterations = 0;    ///< over all levels
};

/// Direct alignment of RGB-D images: bivariate t-distributed residuals of grey value and inverse
/// depth, coarse to fine, Gauss-Newton on SE(3) (Kerl et al., ICRA 2013 and IROS 2013).
/// Keeps its workspace: one per thread. The same calls give the same bits.
class DenseTracker {
 public:
  /// Throws std::invalid_argument when `options` fail their check.
  explicit DenseTracker(const DenseTrackerOptions& options);

  /// From now on looks for planar motions only; none: for all of SE(3).
  void setPlanarMotion(const std::optional<PlanarMotion>& planar) { planar_ = planar; }

  /// Aligns `current` to `reference`; both must come from pyramids of the same shape.
  /// Throws std::invalid_argument when they do not or when there is no start.
  [[nodiscard]] Alignment align(const TrackingReference& reference, const RgbdPyramid& current,
                                const AlignmentStart& start);

 private:
  struct State;
  [[nodiscard]] double misfit(const ReferencePoints& points, ResidualScale scale) const;
  [[nodiscard]] std::vector<State> rankStarts(const ReferencePoints& points,
                                              const RgbdLevel& current,
                                              const AlignmentStart& start);
  [[nodiscard]] State chooseStart(const ReferencePoints& points, const RgbdLevel& current,
                                  const AlignmentStart& start);
  [[nodiscard]] AlignmentStatus alignLevel(const ReferencePoints& points, const RgbdLevel& current,
                                           State& state);
  void addPrior(const State& state, NormalEquations& equations) const;
  [[nodiscard]] std::optional<StepVector> solve(const NormalEquations& equations) const;
  void restrictBrightness(NormalEquations& equations) const;
  void setInformation(const ReferencePoints& points, const State& state,
                      Alignment& alignment) const;

  DenseTrackerOptions options_;
  ScaleModel scale_model_;
  std::optional<PlanarMotion> planar_;
  Residuals residuals_;
};

}  // namespace planecloud

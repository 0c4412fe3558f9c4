// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "planecloud_slam/frontend_node/rgbd_pyramid.h"
#include "planecloud_slam/frontend_node/robust_weight.h"
#include "planecloud_slam/frontend_node/tracking_reference.h"

/// The inner loops of dense tracking, over all points of one level. The residuals at a pose are
///
///     r_grey = (I_current(x) - offset) / gain - I_reference
///     r_q    = q_current(x) - 1 / [T_current_reference p]_z
///
/// with x the projection of the warped point and q inverse depth: Kerl's depth residual (2013b
/// eq. (4)) divided by z^2, so that sensor noise, which grows as z^2, has one scale everywhere.
namespace planecloud {

/// Brightness of the current image as a function of the reference: `I = gain * I_ref + offset`.
struct Brightness {
  double gain = 1.0;
  double offset = 0.0;  ///< [grey levels]
};

/// Residuals of every reference point; keeps its memory.
struct Residuals {
  std::vector<float> grey, q, seen;  ///< see `ResidualView`; padded like the points
  std::size_t in_image = 0;          ///< points that project into the image, on valid depth
  std::size_t agreeing = 0;          ///< of these: depth as predicted to 5 %
  std::size_t seen_count = 0;        ///< of these: depth as predicted to 20 %, not occluded

  [[nodiscard]] ResidualView view() const { return {grey.data(), q.data(), seen.data(), q.size()}; }
};

/// Warps `points` by `T_current_reference` into `current` and compares.
void computeResiduals(const ReferencePoints& points, const RgbdLevel& current,
                      const Eigen::Isometry3d& T_current_reference, const Brightness& brightness,
                      Residuals& residuals);

/// Unknowns of one step: twist of the reference (translation, rotation), then what the grey
/// residual gains per unit: a constant, and `(I_reference - 128) / 64`.
constexpr int kUnknowns = 8;
using StepVector = Eigen::Matrix<double, kUnknowns, 1>;
using StepMatrix = Eigen::Matrix<double, kUnknowns, kUnknowns>;

/// `matrix = sum w J^T Sigma^-1 J`, `vector = sum w J^T Sigma^-1 r` (Kerl 2013b eq. (9)) with t
/// weights `w = (nu + 2) / (nu + r^T Sigma^-1 r)`.
struct NormalEquations {
  StepMatrix matrix = StepMatrix::Zero();
  StepVector vector = StepVector::Zero();
  double error = 0.0;  ///< sum w r^T Sigma^-1 r
};

/// The Jacobians are those of the reference (inverse compositional): a solution `xi` of
/// `matrix xi = vector` moves the pose by `T_current_reference * Exp(-xi)`.
[[nodiscard]] NormalEquations accumulateNormalEquations(const ReferencePoints& points,
                                                        const ResidualView& residuals,
                                                        const ResidualScale& scale, double nu);

/// `sum_b g_b g_b^T` over the image blocks b, where g_b is the block's part of
/// `NormalEquations::vector`: the spread of the gradient when errors within a block are
/// correlated (cluster-robust covariance). Also counts the blocks that contributed.
struct BlockScatter {
  StepMatrix matrix = StepMatrix::Zero();
  int blocks = 0;
};
[[nodiscard]] BlockScatter accumulateBlockScatter(const ReferencePoints& points,
                                                  const ResidualView& residuals,
                                                  const ResidualScale& scale, double nu);

/// A warp and brightness in the precision of the loops.
struct WarpF {
  Eigen::Matrix3f R = Eigen::Matrix3f::Identity();  ///< of T_current_reference
  Eigen::Vector3f t = Eigen::Vector3f::Zero();      ///< of T_current_reference [m]
  float inverse_gain = 1.0F;
  float offset = 0.0F;  ///< [grey levels]
};

/// The loops. Two implementations that agree up to rounding and the order of summation.
struct AlignmentKernels {
  const char* name;
  /// Fills `residuals`, whose arrays have the points' padded size.
  void (*compare)(const ReferencePoints& points, const RgbdLevel& current, const WarpF& warp,
                  Residuals& residuals);
  /// Adds what all points contribute, upper triangle of the matrix only.
  void (*sum)(const ReferencePoints& points, const ResidualView& residuals,
              const Whitening& whitening, NormalEquations& equations);
  /// Adds to the gradient of each block what its points contribute: `kUnknowns` times
  /// `ReferencePoints::kLanes` partial sums a block.
  void (*sum_blocks)(const ReferencePoints& points, const ResidualView& residuals,
                     const Whitening& whitening, float* partial_sums);
};

/// Plain C++: the reference of the tests and the fallback.
[[nodiscard]] const AlignmentKernels& scalarAlignmentKernels();
/// The best this processor has, chosen at run time; the scalar ones when built without Highway.
[[nodiscard]] const AlignmentKernels& vectorAlignmentKernels();

/// Relative inverse depth deviations: see `Residuals`.
constexpr float kAgreeing = 0.05F;
constexpr float kNotOccluded = 0.2F;
/// Grey levels from here on are clipped by an exposure: they say nothing.
constexpr float kSaturated = 250.0F;
/// Relative inverse depth spread of 2x2 pixels of one surface.
constexpr float kCellSpread = 0.1F;
/// The gain unknown multiplies `(I_reference - kMiddleGrey) * kInverseGreySpread`.
constexpr float kMiddleGrey = 128.0F;
constexpr float kInverseGreySpread = 1.0F / 64.0F;

}  // namespace planecloud

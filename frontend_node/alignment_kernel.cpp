// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/frontend_node/alignment_kernel.h"

#include "planecloud_slam/frontend_node/alignment_kernel_scalar.h"

namespace planecloud {

void computeResiduals(const ReferencePoints& points, const RgbdLevel& current,
                      const Eigen::Isometry3d& T_current_reference, const Brightness& brightness,
                      Residuals& residuals) {
  for (std::vector<float>* array : {&residuals.grey, &residuals.q, &residuals.seen}) {
    array->resize(points.paddedCount());
  }
  const WarpF warp{
      T_current_reference.linear().cast<float>(), T_current_reference.translation().cast<float>(),
      static_cast<float>(1.0 / brightness.gain), static_cast<float>(brightness.offset)};
  vectorAlignmentKernels().compare(points, current, warp, residuals);
}

NormalEquations accumulateNormalEquations(const ReferencePoints& points,
                                          const ResidualView& residuals, const ResidualScale& scale,
                                          double nu) {
  NormalEquations equations;
  vectorAlignmentKernels().sum(points, residuals, makeWhitening(scale, nu), equations);
  equations.matrix.triangularView<Eigen::StrictlyLower>() = equations.matrix.transpose();
  return equations;
}

BlockScatter accumulateBlockScatter(const ReferencePoints& points, const ResidualView& residuals,
                                    const ResidualScale& scale, double nu) {
  using Gradient = Eigen::Matrix<float, kUnknowns, 1>;
  const Whitening whitening = makeWhitening(scale, nu);
  std::vector<Gradient> gradients(static_cast<std::size_t>(points.blocks), Gradient::Zero());
  for (std::size_t i = 0; i < points.count; ++i) {
    if (residuals.seen[i] == 0.0F) continue;
    const scalar::WhitenedPoint w = scalar::whiten(points, residuals, whitening, i);
    const float e1 = w.weight * w.e1;
    const float e2 = w.weight * w.e2;
    Gradient& gradient = gradients[points.block[i]];
    for (int k = 0; k < 6; ++k) {
      const auto row = static_cast<std::size_t>(k);
      gradient(k) += e1 * w.row1[row] + e2 * w.row2[row];
    }
    gradient(6) += e1 * w.offset;
    gradient(7) += e1 * w.gain;
  }
  BlockScatter scatter;
  for (const Gradient& gradient : gradients) {
    if (gradient.isZero(0.0F)) continue;
    const StepVector g = gradient.cast<double>();
    scatter.matrix += g * g.transpose();
    ++scatter.blocks;
  }
  return scatter;
}

}  // namespace planecloud

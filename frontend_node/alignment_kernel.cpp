// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/frontend_node/alignment_kernel.h"

#include <vector>

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
  constexpr auto kLanes = static_cast<Eigen::Index>(ReferencePoints::kLanes);
  using PartialSums = Eigen::Matrix<float, kUnknowns, kLanes, Eigen::RowMajor>;
  std::vector<PartialSums> blocks(static_cast<std::size_t>(points.blocks), PartialSums::Zero());
  vectorAlignmentKernels().sum_blocks(points, residuals, makeWhitening(scale, nu),
                                      blocks.data()->data());
  BlockScatter scatter;
  for (const PartialSums& block : blocks) {
    if (block.isZero(0.0F)) continue;
    const StepVector g = block.rowwise().sum().cast<double>();
    scatter.matrix += g * g.transpose();
    ++scatter.blocks;
  }
  return scatter;
}

}  // namespace planecloud

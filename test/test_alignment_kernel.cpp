// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "planecloud_slam/frontend_node/alignment_kernel.h"
#include "synthetic_scene.h"

namespace planecloud {
namespace {

using synthetic::pose;

RgbdPyramid pyramidAt(const Eigen::Isometry3d& T_world_camera, unsigned seed) {
  const RgbdFrame frame =
      synthetic::render(synthetic::camera(), T_world_camera, {2.0, 0.004, 1.0, 0.0, seed});
  RgbdPyramid pyramid(synthetic::camera(), DenseTrackerOptions());
  pyramid.assign(frame.grey.view(), frame.depth.view());
  return pyramid;
}

/// What one implementation makes of a pair of images that overlap in part.
struct Comparison {
  Residuals residuals;
  NormalEquations equations;

  Comparison(const AlignmentKernels& kernels, const ReferencePoints& points,
             const RgbdLevel& current) {
    for (std::vector<float>* array : {&residuals.grey, &residuals.q, &residuals.seen}) {
      array->assign(points.paddedCount(), -1.0F);
    }
    const Eigen::Isometry3d T = pose(0.1, -0.05, 0.08, 0.03, -0.1, 0.05);
    kernels.compare(points, current,
                    {T.linear().cast<float>(), T.translation().cast<float>(), 1.1F, 3.0F},
                    residuals);
    kernels.sum(points, residuals.view(), {1.0F / 8.0F, 1.0F / 0.03F, 12.0F, 5.0F}, equations);
  }
};

TEST(AlignmentKernel, VectorAndScalarLoopsAgreeToRounding) {
  const DenseTrackerOptions options;
  const RgbdPyramid reference = pyramidAt(pose(0, 0, 0), 1);
  const RgbdPyramid current = pyramidAt(pose(0.1, 0, 0, 0, 0.05, 0), 2);
  const TrackingReference points(reference, options);
  for (std::size_t level = 0; level < points.levels().size(); ++level) {
    const ReferencePoints& at = points.levels()[level];
    const Comparison scalar(scalarAlignmentKernels(), at, current.levels()[level]);
    const Comparison vector(vectorAlignmentKernels(), at, current.levels()[level]);
    ASSERT_GT(scalar.residuals.seen_count, 300U);
    ASSERT_LT(scalar.residuals.seen_count, at.count);
    // Points on the border of the image or of a threshold may fall to either side: 1 in 1000.
    const auto few = static_cast<double>(at.count) / 1000.0 + 1.0;
    EXPECT_NEAR(static_cast<double>(scalar.residuals.in_image),
                static_cast<double>(vector.residuals.in_image), few);
    EXPECT_NEAR(static_cast<double>(scalar.residuals.agreeing),
                static_cast<double>(vector.residuals.agreeing), few);
    std::size_t different = 0;
    for (std::size_t i = 0; i < at.paddedCount(); ++i) {
      // Rounding of the pixel position, 2e-5 px, times the steepest gradients.
      const bool equal = std::abs(scalar.residuals.grey[i] - vector.residuals.grey[i]) < 5e-3F &&
                         std::abs(scalar.residuals.q[i] - vector.residuals.q[i]) < 1e-5F &&
                         scalar.residuals.seen[i] == vector.residuals.seen[i];
      different += equal ? 0U : 1U;
    }
    EXPECT_LT(static_cast<double>(different), few);
  }
}

TEST(AlignmentKernel, VectorAndScalarSumsAgreeToRounding) {
  const RgbdPyramid reference = pyramidAt(pose(0, 0, 0), 1);
  const RgbdPyramid current = pyramidAt(pose(0.1, 0, 0, 0, 0.05, 0), 2);
  const TrackingReference points(reference, DenseTrackerOptions());
  const Comparison compared(scalarAlignmentKernels(), points.levels().front(),
                            current.levels().front());
  NormalEquations vector;
  vectorAlignmentKernels().sum(points.levels().front(), compared.residuals.view(),
                               {1.0F / 8.0F, 1.0F / 0.03F, 12.0F, 5.0F}, vector);
  // Sums of 2048 floats at a time: a relative error of 2048 * 6e-8 at worst.
  const double scale = compared.equations.matrix.diagonal().maxCoeff();
  EXPECT_LT((compared.equations.matrix - vector.matrix).cwiseAbs().maxCoeff(), 1e-5 * scale);
  EXPECT_NEAR(compared.equations.error, vector.error, 1e-4 * compared.equations.error);
  EXPECT_LT((compared.equations.vector - vector.vector).norm(),
            1e-4 * compared.equations.vector.norm() + 1e-6 * scale);
}

TEST(AlignmentKernel, VectorAndScalarBlocksAgreeToRounding) {
  const RgbdPyramid reference = pyramidAt(pose(0, 0, 0), 1);
  const RgbdPyramid current = pyramidAt(pose(0.1, 0, 0, 0, 0.05, 0), 2);
  const TrackingReference reference_points(reference, DenseTrackerOptions());
  const ReferencePoints& points = reference_points.levels().front();
  const Comparison comparison(scalarAlignmentKernels(), points, current.levels().front());
  constexpr std::size_t kSize = kUnknowns * ReferencePoints::kLanes;
  std::vector<float> a(static_cast<std::size_t>(points.blocks) * kSize, 0.0F), b(a);
  const Whitening whitening{1.0F / 8.0F, 1.0F / 0.03F, 12.0F, 5.0F};
  scalarAlignmentKernels().sum_blocks(points, comparison.residuals.view(), whitening, a.data());
  vectorAlignmentKernels().sum_blocks(points, comparison.residuals.view(), whitening, b.data());
  int filled = 0;
  for (std::size_t row = 0; row < a.size(); row += ReferencePoints::kLanes) {
    float sum_a = 0.0F, sum_b = 0.0F, size = 0.0F;
    for (std::size_t i = row; i < row + ReferencePoints::kLanes; ++i) {
      sum_a += a[i], sum_b += b[i], size += std::abs(a[i]);
    }
    EXPECT_NEAR(sum_a, sum_b, 1e-3F * size + 1e-6F);
    filled += size > 0.0F ? 1 : 0;
  }
  EXPECT_GT(filled, 100);
}

TEST(AlignmentKernel, PaddingIsNeverSeen) {
  const RgbdPyramid reference = pyramidAt(pose(0, 0, 0), 1);
  const TrackingReference points(reference, DenseTrackerOptions());
  for (const AlignmentKernels* kernels : {&scalarAlignmentKernels(), &vectorAlignmentKernels()}) {
    for (std::size_t level = 0; level < points.levels().size(); ++level) {
      const ReferencePoints& at = points.levels()[level];
      const Comparison compared(*kernels, at, reference.levels()[level]);
      for (std::size_t i = at.count; i < at.paddedCount(); ++i) {
        EXPECT_EQ(compared.residuals.seen[i], 0.0F) << kernels->name;
        EXPECT_EQ(compared.residuals.grey[i], 0.0F) << kernels->name;
      }
    }
  }
}

}  // namespace
}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/frontend_node/alignment_kernel_scalar.h"

#include <algorithm>
#include <cmath>

namespace planecloud {
namespace scalar {
namespace {

float interpolate(const std::array<float, 4>& corners, float fx, float fy) {
  const float upper = corners[0] + fx * (corners[1] - corners[0]);
  const float lower = corners[2] + fx * (corners[3] - corners[2]);
  return upper + fy * (lower - upper);
}

/// Inverse depth between four pixels: linear within one surface (exact on a plane), else that of
/// the nearest pixel; 0 when there is none.
float sampleInverseDepth(const std::array<float, 4>& q, float fx, float fy) {
  const float low = std::min(std::min(q[0], q[1]), std::min(q[2], q[3]));
  const float high = std::max(std::max(q[0], q[1]), std::max(q[2], q[3]));
  if (low > (1.0F - kCellSpread) * high) return interpolate(q, fx, fy);
  return q[(fy < 0.5F ? 0U : 2U) + (fx < 0.5F ? 0U : 1U)];
}

void comparePoint(const ReferencePoints& points, const RgbdLevel& current, const WarpF& warp,
                  std::size_t i, Residuals& out) {
  out.grey[i] = out.q[i] = out.seen[i] = 0.0F;
  const LevelCamera& camera = current.camera;
  const Eigen::Vector3f ray(points.u[i], points.v[i], 1.0F);
  const Eigen::Vector3f point = warp.R * ray + warp.t * points.q[i];
  const float x = camera.fx * (point.x() / point.z()) + camera.cx;
  const float y = camera.fy * (point.y() / point.z()) + camera.cy;
  const float predicted = points.q[i] / point.z();
  const auto right = static_cast<float>(camera.width - 1);
  const auto bottom = static_cast<float>(camera.height - 1);
  if (!(x >= 0.0F && x < right && y >= 0.0F && y < bottom && predicted > 0.0F)) return;
  const int column = static_cast<int>(x);
  const int row = static_cast<int>(y);
  const float fx = x - static_cast<float>(column);
  const float fy = y - static_cast<float>(row);
  const GreyDepth* upper = current.pixels.row(row) + column;
  const GreyDepth* lower = upper + camera.width;
  const float q = sampleInverseDepth({upper[0].inverse_depth, upper[1].inverse_depth,
                                      lower[0].inverse_depth, lower[1].inverse_depth},
                                     fx, fy);
  if (!(q > 0.0F)) return;
  const float deviation = std::abs(q - predicted);
  ++out.in_image;
  out.agreeing += deviation < kAgreeing * predicted ? 1U : 0U;
  if (deviation > kNotOccluded * predicted) return;
  const float grey =
      interpolate({upper[0].grey, upper[1].grey, lower[0].grey, lower[1].grey}, fx, fy);
  if (!(grey < kSaturated)) return;
  out.grey[i] = (grey - warp.offset) * warp.inverse_gain - points.grey[i];
  out.q[i] = q - predicted;
  out.seen[i] = 1.0F;
  ++out.seen_count;
}

void compare(const ReferencePoints& points, const RgbdLevel& current, const WarpF& warp,
             Residuals& out) {
  out.in_image = out.agreeing = out.seen_count = 0;
  for (std::size_t i = 0; i < points.paddedCount(); ++i) {
    comparePoint(points, current, warp, i, out);
  }
}

void sum(const ReferencePoints& points, const ResidualView& residuals, const Whitening& whitening,
         NormalEquations& equations) {
  for (std::size_t i = 0; i < residuals.count; ++i) {
    const WhitenedPoint w = whiten(points, residuals, whitening, i);
    if (w.weight == 0.0F) continue;
    StepVector row1, row2;
    for (int k = 0; k < 6; ++k) {
      row1(k) = w.row1[static_cast<std::size_t>(k)];
      row2(k) = w.row2[static_cast<std::size_t>(k)];
    }
    row1.tail<2>() << w.offset, w.gain;
    row2.tail<2>().setZero();
    const double weight = w.weight;
    equations.matrix.triangularView<Eigen::Upper>() +=
        weight * (row1 * row1.transpose() + row2 * row2.transpose());
    equations.vector += weight * (w.e1 * row1 + w.e2 * row2);
    equations.error += weight * (w.e1 * w.e1 + w.e2 * w.e2);
  }
}

void sumBlocks(const ReferencePoints& points, const ResidualView& residuals,
               const Whitening& whitening, float* partial_sums) {
  for (std::size_t i = 0; i < points.count; ++i) {
    if (residuals.seen[i] == 0.0F) continue;
    const WhitenedPoint w = whiten(points, residuals, whitening, i);
    const float e1 = w.weight * w.e1;
    const float e2 = w.weight * w.e2;
    constexpr std::size_t kLanes = ReferencePoints::kLanes;
    float* sums = partial_sums + points.block[i] * kUnknowns * kLanes + i % kLanes;
    for (std::size_t k = 0; k < 6; ++k) sums[k * kLanes] += e1 * w.row1[k] + e2 * w.row2[k];
    sums[6 * kLanes] += e1 * w.offset;
    sums[7 * kLanes] += e1 * w.gain;
  }
}

}  // namespace
}  // namespace scalar

const AlignmentKernels& scalarAlignmentKernels() {
  static const AlignmentKernels kernels{"scalar", &scalar::compare, &scalar::sum,
                                        &scalar::sumBlocks};
  return kernels;
}

#ifndef PLANECLOUD_SLAM_HAVE_HIGHWAY
const AlignmentKernels& vectorAlignmentKernels() { return scalarAlignmentKernels(); }
#endif

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/icap/align_plane_pairs.h"

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <algorithm>
#include <stdexcept>

namespace planecloud {
namespace {

constexpr double kRounding = 1e-12;  // relative size of what double arithmetic makes of a zero

void require(bool condition, const char* text) {
  if (!condition) throw std::invalid_argument(text);
}

void checkArguments(const std::vector<PlanePair>& pairs, double observable_share) {
  double total_weight = 0.0;
  for (const PlanePair& pair : pairs) {
    require(pair.weight >= 0.0, "alignPlanePairs: weights must not be negative");
    total_weight += pair.weight;
  }
  require(total_weight > 0.0, "alignPlanePairs: at least one pair needs a positive weight");
  require(observable_share >= 0.0 && observable_share < 1.0,
          "alignPlanePairs: observable_share must be in [0, 1)");
}

/// Paper eq. (6)-(8).
void solveRotation(const std::vector<PlanePair>& pairs, PlaneAlignment& alignment) {
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const PlanePair& pair : pairs) {
    covariance += pair.weight * pair.target.head<3>() * pair.source.head<3>().transpose();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance,
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Matrix3d& U = svd.matrixU();
  const Eigen::Matrix3d& V = svd.matrixV();
  const double handedness = (U * V.transpose()).determinant() < 0.0 ? -1.0 : 1.0;
  alignment.T_target_source.linear() =
      U * Eigen::Vector3d(1.0, 1.0, handedness).asDiagonal() * V.transpose();
  const double smallest = kRounding * svd.singularValues()(0);
  alignment.rotation_rank = static_cast<int>((svd.singularValues().array() > smallest).count());
}

/// Paper eq. (9), in the eigenvectors of the normal matrix.
void solveTranslation(const std::vector<PlanePair>& pairs, double observable_share,
                      PlaneAlignment& alignment) {
  Eigen::Matrix3d normal_matrix = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right_side = Eigen::Vector3d::Zero();
  for (const PlanePair& pair : pairs) {
    const Eigen::Vector3d n = alignment.T_target_source.linear() * pair.source.head<3>();
    normal_matrix += pair.weight * n * n.transpose();
    right_side += pair.weight * n * (pair.source.w() - pair.target.w());
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(normal_matrix);
  const double smallest = std::max(observable_share, kRounding) * eigen.eigenvalues()(2);
  for (Eigen::Index i = 0; i < 3; ++i) {
    if (eigen.eigenvalues()(i) <= smallest) continue;
    const Eigen::Vector3d direction = eigen.eigenvectors().col(i);
    alignment.T_target_source.translation() +=
        direction * (direction.dot(right_side) / eigen.eigenvalues()(i));
    ++alignment.translation_rank;
  }
}

}  // namespace

PlaneAlignment alignPlanePairs(const std::vector<PlanePair>& pairs, double observable_share) {
  checkArguments(pairs, observable_share);
  PlaneAlignment alignment;
  solveRotation(pairs, alignment);
  solveTranslation(pairs, observable_share, alignment);
  return alignment;
}

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/icap/icap_paper.h"

#include "planecloud_slam/icap/align_plane_pairs.h"
#include "planecloud_slam/icap/kd_tree.h"

namespace planecloud {
namespace {

constexpr double kSettled = 1e-10;  // tau_T: squared Frobenius norm of the transform's change

Eigen::Vector4d coefficients(const PlanePatch& patch) {
  return {patch.normal.x(), patch.normal.y(), patch.normal.z(), patch.d};
}

std::vector<Eigen::Vector4f> coefficients(const std::vector<PlanePatch>& patches) {
  std::vector<Eigen::Vector4f> points;
  points.reserve(patches.size());
  for (const PlanePatch& patch : patches) points.push_back(coefficients(patch).cast<float>());
  return points;
}

/// Planes move by `pi' = T^-T pi`.
Eigen::Vector4d moved(const Eigen::Isometry3d& T, const Eigen::Vector4d& plane) {
  const Eigen::Vector3d normal = T.linear() * plane.head<3>();
  return {normal.x(), normal.y(), normal.z(), plane.w() - normal.dot(T.translation())};
}

}  // namespace

PaperAlignment alignAsPrinted(const PlaneSet& target, const PlaneSet& source,
                              const Eigen::Isometry3d& T_target_source_guess, int max_iterations) {
  const std::vector<PlanePatch>& targets = target.patches(PlaneSet::Level::kWhole);
  const std::vector<PlanePatch>& sources = source.patches(PlaneSet::Level::kWhole);
  const KdTree<4> index(coefficients(targets));
  PaperAlignment result;
  result.T_target_source = T_target_source_guess;
  while (!result.settled && result.iterations < max_iterations) {
    result.matches.clear();
    std::vector<PlanePair> pairs;
    for (const PlanePatch& patch : sources) {
      const Eigen::Vector4d query = moved(result.T_target_source, coefficients(patch));
      const PlanePatch& nearest = targets[index.nearest<1>(query.cast<float>()).first[0]];
      result.matches.push_back({&nearest, &patch});
      pairs.push_back({coefficients(nearest), coefficients(patch), 1.0});
    }
    const Eigen::Isometry3d T = alignPlanePairs(pairs).T_target_source;
    const double change = (T.matrix() - result.T_target_source.matrix()).squaredNorm();
    result.T_target_source = T;
    result.settled = change < kSettled;
    ++result.iterations;
  }
  return result;
}

}  // namespace planecloud

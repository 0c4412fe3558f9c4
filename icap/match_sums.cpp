// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/icap/match_sums.h"

#include <algorithm>
#include <cstddef>

#include "planecloud_slam/icap/plane_set.h"
#include "planecloud_slam/plane_fit/se3.h"

namespace planecloud {
namespace {

/// Geman-McClure: weight of a residual of `squared` standard deviations^2.
double kernelWeight(double squared, double width) {
  const double root = 1.0 / (1.0 + squared / (width * width));
  return root * root;
}

double variance(double target, double source, double floor) {
  return target * target + source * source + floor * floor;
}

/// One match in the source's axes.
struct Residual {
  Eigen::Vector3d normal;      ///< of both patches, the surer one counting more
  Eigen::Vector3d point;       ///< source centroid
  Eigen::Vector3d difference;  ///< source normal minus target normal
  double distance = 0.0;       ///< between the patches along `normal` [m]
  double distance_variance = 0.0;
  double normal_variance = 0.0;  ///< of `normal`, each direction
};

Residual residualOf(const PatchMatch& match, const Eigen::Isometry3d& T_source_target,
                    const MatchWeighing& weighing) {
  const PlanePatch& target = *match.target;
  const PlanePatch& source = *match.source;
  const Eigen::Vector3d target_normal = T_source_target.linear() * target.normal;
  const double target_variance = target.normal_sigma * target.normal_sigma;
  const double source_variance = source.normal_sigma * source.normal_sigma;
  const double target_share = source_variance / (target_variance + source_variance);
  Residual r;
  r.normal = (target_share * target_normal + (1.0 - target_share) * source.normal).normalized();
  r.point = source.centroid;
  r.difference = source.normal - target_normal;
  const Eigen::Vector3d offset = r.point - T_source_target * target.centroid;
  r.distance = r.normal.dot(offset);
  r.normal_variance =
      target_share * target_variance + weighing.normal_floor * weighing.normal_floor;
  // A wrong normal turns the sideways offset of the two centroids into distance.
  const double lever = std::max(0.0, offset.squaredNorm() - r.distance * r.distance);
  r.distance_variance =
      variance(target.distance_sigma, source.distance_sigma, weighing.distance_floor) +
      lever * r.normal_variance;
  return r;
}

/// Adds `weight v v^T`, upper half, row after row.
template <int Size>
void addSquare(const Eigen::Matrix<double, Size, 1>& v, double weight,
               std::array<double, Size*(Size + 1) / 2>& sum) {
  std::size_t entry = 0;
  for (Eigen::Index row = 0; row < Size; ++row) {
    for (Eigen::Index column = row; column < Size; ++column) {
      sum[entry++] += weight * v[row] * v[column];
    }
  }
}

void addDistance(const Residual& r, double weight, MatchSums& sums) {
  Vector6d jacobian;  // of the distance by a twist
  jacobian << r.normal, r.point.cross(r.normal);
  const double spread = weight * r.normal_variance;
  addSquare<6>(jacobian, weight, sums.hessian);
  addSquare<6>(jacobian, spread, sums.spread_along);
  addSquare<3>(r.point, spread, sums.spread_square);
  Eigen::Map<Vector6d>(sums.gradient.data()) += weight * r.distance * jacobian;
  sums.spread += spread;
  Eigen::Map<Eigen::Vector3d>(sums.spread_point.data()) += spread * r.point;
}

void addNormal(const Residual& r, const Eigen::Vector3d& source_normal, double weight,
               double normal_variance, MatchSums& sums) {
  // m + phi x m - n = difference - [m]x phi, and [m]x^T [m]x = I - m m^T.
  sums.weight += weight;
  addSquare<3>(source_normal, weight, sums.dyads);
  sums.weight_variance += weight * normal_variance;
  addSquare<3>(source_normal, weight * normal_variance, sums.dyads_variance);
  Eigen::Map<Vector6d>(sums.gradient.data()).tail<3>() +=
      weight * source_normal.cross(r.difference);
}

}  // namespace

MatchSums sumMatchesScalar(const std::vector<PatchMatch>& matches,
                           const Eigen::Isometry3d& T_source_target,
                           const MatchWeighing& weighing) {
  MatchSums sums;
  for (const PatchMatch& match : matches) {
    const Residual r = residualOf(match, T_source_target, weighing);
    const double normal_variance =
        variance(match.target->normal_sigma, match.source->normal_sigma, weighing.normal_floor);
    const double squared = r.distance * r.distance / r.distance_variance;
    const double weight = kernelWeight(squared, weighing.kernel_width);
    const double squared_normal = r.difference.squaredNorm() / normal_variance;
    const double joint_weight = weight * kernelWeight(squared_normal, weighing.kernel_width);
    addDistance(r, joint_weight / r.distance_variance, sums);
    addNormal(r, match.source->normal, joint_weight / normal_variance, normal_variance, sums);
    sums.weighted_error += weight * squared;
    sums.kernel_weight += weight;
    sums.squared_distance += r.distance * r.distance;
  }
  return sums;
}

#ifndef PLANECLOUD_SLAM_HAVE_HIGHWAY
MatchSums sumMatches(const std::vector<PatchMatch>& matches,
                     const Eigen::Isometry3d& T_source_target, const MatchWeighing& weighing) {
  return sumMatchesScalar(matches, T_source_target, weighing);
}
#endif

}  // namespace planecloud

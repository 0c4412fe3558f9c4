// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/icap/plane_normal_equations.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

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

Residual residualOf(const PlanePatch& target, const PlanePatch& source,
                    const Eigen::Isometry3d& T_source_target, const IcapOptions& options) {
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
  r.normal_variance = target_share * target_variance + options.normal_floor * options.normal_floor;
  // A wrong normal turns the sideways offset of the two centroids into distance.
  const double lever = std::max(0.0, offset.squaredNorm() - r.distance * r.distance);
  r.distance_variance =
      variance(target.distance_sigma, source.distance_sigma, options.distance_floor) +
      lever * r.normal_variance;
  return r;
}

/// Sums over matches from which the system is made: some hundred bytes instead of products of
/// matrices for every match.
class Sums {
 public:
  void addDistance(const Residual& r, double weight) {
    Vector6d jacobian;  // of the distance by a twist
    jacobian << r.normal, r.point.cross(r.normal);
    const double spread = weight * r.normal_variance;
    for (Eigen::Index column = 0; column < 6; ++column) {  // symmetric: the lower half in `finish`
      for (Eigen::Index row = 0; row <= column; ++row) {
        const double product = jacobian[row] * jacobian[column];
        hessian_(row, column) += weight * product;
        spread_along_(row, column) += spread * product;
      }
    }
    gradient_ += weight * r.distance * jacobian;
    spread_ += spread;
    spread_point_ += spread * r.point;
    spread_square_.noalias() += spread * r.point * r.point.transpose();
  }

  void addNormal(const Residual& r, const Eigen::Vector3d& source_normal, double weight,
                 double normal_variance) {
    // n + phi x n - m = difference - [n]x phi, and [n]x^T [n]x = I - n n^T.
    const Eigen::Matrix3d dyad = source_normal * source_normal.transpose();
    weight_ += weight;
    dyads_ += weight * dyad;
    weight_variance_ += weight * normal_variance;
    dyads_variance_ += weight * normal_variance * dyad;
    gradient_.tail<3>() += weight * source_normal.cross(r.difference);
  }

  void finish(PlaneNormalEquations& system) const {
    const Eigen::Matrix3d identity = Eigen::Matrix3d::Identity();
    system.hessian = hessian_.selfadjointView<Eigen::Upper>();
    system.hessian.bottomRightCorner<3, 3>() += weight_ * identity - dyads_;
    system.gradient = gradient_;
    // Across its normal a point's motion under a twist, [I, -[p]x], turns into distance by the
    // error of the normal: sum of s M^T (I - n n^T) M.
    system.noise.topLeftCorner<3, 3>() = spread_ * identity;
    system.noise.topRightCorner<3, 3>() = -skew(spread_point_);
    system.noise.bottomLeftCorner<3, 3>() = skew(spread_point_);
    system.noise.bottomRightCorner<3, 3>() = spread_square_.trace() * identity - spread_square_;
    system.noise -= Matrix6d(spread_along_.selfadjointView<Eigen::Upper>());
    system.noise.bottomRightCorner<3, 3>() += weight_variance_ * identity + dyads_variance_;
  }

 private:
  Matrix6d hessian_ = Matrix6d::Zero();
  Vector6d gradient_ = Vector6d::Zero();
  Matrix6d spread_along_ = Matrix6d::Zero();
  double spread_ = 0.0;
  Eigen::Vector3d spread_point_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d spread_square_ = Eigen::Matrix3d::Zero();
  double weight_ = 0.0;
  Eigen::Matrix3d dyads_ = Eigen::Matrix3d::Zero();
  double weight_variance_ = 0.0;
  Eigen::Matrix3d dyads_variance_ = Eigen::Matrix3d::Zero();
};

}  // namespace

PlaneNormalEquations buildNormalEquations(const std::vector<PatchMatch>& matches,
                                          const Eigen::Isometry3d& T_target_source,
                                          double kernel_width, const IcapOptions& options) {
  PlaneNormalEquations system;
  Sums sums;
  const Eigen::Isometry3d T_source_target = T_target_source.inverse();
  for (const PatchMatch& match : matches) {
    const PlanePatch& target = *match.target;
    const PlanePatch& source = *match.source;
    const Residual r = residualOf(target, source, T_source_target, options);
    const double normal_variance =
        variance(target.normal_sigma, source.normal_sigma, options.normal_floor);
    const double squared = r.distance * r.distance / r.distance_variance;
    const double weight = kernelWeight(squared, kernel_width);
    const double squared_normal = r.difference.squaredNorm() / normal_variance;
    const double joint_weight = weight * kernelWeight(squared_normal, kernel_width);
    sums.addDistance(r, joint_weight / r.distance_variance);
    sums.addNormal(r, source.normal, joint_weight / normal_variance, normal_variance);
    system.weighted_error += weight * squared;
    system.weight += weight;
    system.squared_distance += r.distance * r.distance;
  }
  sums.finish(system);
  return system;
}

Observability analyseObservability(const PlaneNormalEquations& system, double factor) {
  // The noise makes a natural unit for every direction: moving the patches by their own errors.
  const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix6d> eigen(system.hessian, system.noise);
  const Eigen::Index dark = (eigen.eigenvalues().array() < factor).count();
  Observability result;
  // Eigenvalues ascend: the first `dark` eigenvectors span what is not observed.
  const Matrix6d basis =
      Eigen::Matrix<double, 6, Eigen::Dynamic>(eigen.eigenvectors().leftCols(dark))
          .householderQr()
          .householderQ();
  result.unobserved = basis.leftCols(dark);
  result.observed = basis.rightCols(6 - dark);
  return result;
}

Vector6d leastObserved(const PlaneNormalEquations& system) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix6d> eigen(system.hessian, system.noise);
  return eigen.eigenvectors().col(0).normalized();
}

Vector6d solveObserved(const PlaneNormalEquations& system, const Observability& observability) {
  const Eigen::Matrix<double, 6, Eigen::Dynamic>& basis = observability.observed;
  if (basis.cols() == 0) return Vector6d::Zero();
  const Eigen::MatrixXd reduced = basis.transpose() * system.hessian * basis;
  return -basis * reduced.ldlt().solve(basis.transpose() * system.gradient);
}

}  // namespace planecloud

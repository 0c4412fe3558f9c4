// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/backend_node/pose_graph_solver.h"

#include <ceres/ceres.h>
#include <ceres/version.h>

#include <Eigen/Core>
#include <array>
#include <memory>

#include "planecloud_slam/backend_node/dynamic_covariance_scaling.h"
#include "planecloud_slam/backend_node/relative_pose_cost.h"

namespace planecloud {
namespace {

/// A pose as Ceres keeps it: translation x y z, unit quaternion x y z w.
constexpr int kPoseSize = 7;
using PoseBlock = std::array<double, kPoseSize>;
using RowMajor67 = Eigen::Matrix<double, 6, kPoseSize, Eigen::RowMajor>;
using RowMajor76 = Eigen::Matrix<double, kPoseSize, 6, Eigen::RowMajor>;

Eigen::Isometry3d toPose(const double* block) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() = Eigen::Map<const Eigen::Vector3d>(block);
  T.linear() = Eigen::Map<const Eigen::Quaterniond>(block + 3).normalized().toRotationMatrix();
  return T;
}

void fromPose(const Eigen::Isometry3d& T, double* block) {
  Eigen::Map<Eigen::Vector3d>{block} = T.translation();
  Eigen::Map<Eigen::Quaterniond>{block + 3} = Eigen::Quaterniond(T.linear()).normalized();
}

bool plus(const double* x, const double* delta, double* x_plus_delta) {
  const Eigen::Map<const Vector6d> xi(delta);
  fromPose(toPose(x) * expSe3(xi), x_plus_delta);
  return true;
}

/// The costs differentiate by the six perturbations and write them into the first six of the seven
/// columns, so this one only picks those.
bool plusJacobian(double* jacobian) {
  Eigen::Map<RowMajor76>{jacobian}.setIdentity();
  return true;
}

#if CERES_VERSION_MAJOR > 2 || (CERES_VERSION_MAJOR == 2 && CERES_VERSION_MINOR >= 1)
class PoseManifold final : public ceres::Manifold {
 public:
  int AmbientSize() const override { return kPoseSize; }
  int TangentSize() const override { return 6; }
  bool Plus(const double* x, const double* delta, double* x_plus_delta) const override {
    return plus(x, delta, x_plus_delta);
  }
  bool PlusJacobian(const double* /*x*/, double* jacobian) const override {
    return plusJacobian(jacobian);
  }
  bool Minus(const double* y, const double* x, double* y_minus_x) const override {
    Eigen::Map<Vector6d>{y_minus_x} = logSe3(toPose(x).inverse() * toPose(y));
    return true;
  }
  bool MinusJacobian(const double* /*x*/, double* jacobian) const override {
    Eigen::Map<RowMajor67>{jacobian}.setIdentity();
    return true;
  }
};
void setManifold(ceres::Problem& problem, double* block, PoseManifold* manifold) {
  problem.SetManifold(block, manifold);
}
void keepManifolds(ceres::Problem::Options& options) {
  options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
}
#else
class PoseManifold final : public ceres::LocalParameterization {
 public:
  int GlobalSize() const override { return kPoseSize; }
  int LocalSize() const override { return 6; }
  bool Plus(const double* x, const double* delta, double* x_plus_delta) const override {
    return plus(x, delta, x_plus_delta);
  }
  bool ComputeJacobian(const double* /*x*/, double* jacobian) const override {
    return plusJacobian(jacobian);
  }
};
void setManifold(ceres::Problem& problem, double* block, PoseManifold* manifold) {
  problem.SetParameterization(block, manifold);
}
void keepManifolds(ceres::Problem::Options& options) {
  options.local_parameterization_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
}
#endif

class EdgeCost final : public ceres::SizedCostFunction<6, kPoseSize, kPoseSize> {
 public:
  explicit EdgeCost(const RelativePoseCost& cost) : cost_(cost) {}

  bool Evaluate(double const* const* poses, double* residuals, double** jacobians) const override {
    const Eigen::Isometry3d T_map_from = toPose(poses[0]);
    const Eigen::Isometry3d T_map_to = toPose(poses[1]);
    Eigen::Map<Vector6d> residual(residuals);
    if (jacobians == nullptr) {
      residual = cost_.residual(T_map_from, T_map_to);
      return true;
    }
    const RelativePoseCost::Linearisation linear = cost_.linearise(T_map_from, T_map_to);
    residual = linear.residual;
    write(linear.by_from, jacobians[0]);
    write(linear.by_to, jacobians[1]);
    return true;
  }

 private:
  static void write(const Matrix6d& by_perturbation, double* jacobian) {
    if (jacobian == nullptr) return;
    Eigen::Map<RowMajor67> target(jacobian);
    target.leftCols<6>() = by_perturbation;
    target.col(6).setZero();
  }

  RelativePoseCost cost_;
};

/// See dynamicCovarianceScaling.
class DcsLoss : public ceres::LossFunction {
 public:
  explicit DcsLoss(double width) : width_(width) {}

  void Evaluate(double square, double rho[3]) const override {
    const KernelValue kernel = dynamicCovarianceScaling(square, width_);
    rho[0] = kernel.value;
    rho[1] = kernel.slope;
    rho[2] = kernel.curvature;
  }

 private:
  double width_;
};

std::unique_ptr<ceres::LossFunction> makeKernel(const PoseGraphOptions& options) {
  switch (options.kernel) {
    case RobustKernel::kNone:
      return nullptr;
    case RobustKernel::kHuber:
      return std::make_unique<ceres::HuberLoss>(options.kernel_width);
    case RobustKernel::kCauchy:
      return std::make_unique<ceres::CauchyLoss>(options.kernel_width);
    case RobustKernel::kDcs:
      return std::make_unique<DcsLoss>(options.kernel_width);
  }
  return nullptr;
}

/// What tracking's edges do not know of their own error.
Matrix6d effectiveInformation(const GraphEdge& edge, const PoseGraphOptions& options) {
  if (isMadeByBackend(edge.kind)) return edge.information;
  return withErrorFloor(edge.information, options.odometry_translation_floor,
                        options.odometry_rotation_floor);
}

ceres::Solver::Options solverOptions(const PoseGraphOptions& options, double tolerance) {
  ceres::Solver::Options result;
  result.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  result.max_num_iterations = options.max_iterations;
  result.num_threads = options.threads;
  result.function_tolerance = tolerance;
  // Ceres' own damping is so weak that rounding errors drive the poses far along directions without
  // information. All other columns are scaled to about one, so this leaves them alone.
  result.min_lm_diagonal = 1.0;
  result.max_trust_region_radius = 1e6;
  result.logging_type = ceres::SILENT;
  return result;
}

}  // namespace

void solvePoseGraph(const PoseGraphOptions& options, PoseGraphProblem& problem,
                    OptimisationSummary& summary) {
  std::vector<PoseBlock> blocks(problem.poses.size());
  PoseManifold manifold;
  const std::unique_ptr<ceres::LossFunction> kernel = makeKernel(options);
  ceres::Problem::Options problem_options;
  keepManifolds(problem_options);
  problem_options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem ceres_problem(problem_options);
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    fromPose(problem.poses[i], blocks[i].data());
    ceres_problem.AddParameterBlock(blocks[i].data(), kPoseSize);
    setManifold(ceres_problem, blocks[i].data(), &manifold);
    if (problem.fixed[i]) ceres_problem.SetParameterBlockConstant(blocks[i].data());
  }
  for (const PoseGraphProblem::Edge& edge : problem.edges) {
    const GraphEdge& measurement = edge.measurement;
    const RelativePoseCost cost(measurement.T_from_to, effectiveInformation(measurement, options));
    ceres_problem.AddResidualBlock(new EdgeCost(cost),
                                   measurement.kind == EdgeKind::kOdometry ? nullptr : kernel.get(),
                                   blocks[static_cast<std::size_t>(edge.from)].data(),
                                   blocks[static_cast<std::size_t>(edge.to)].data());
  }
  ceres::Solver::Summary report;
  ceres::Solve(solverOptions(options, problem.tolerance), &ceres_problem, &report);
  summary.iterations += static_cast<int>(report.iterations.size());
  summary.initial_cost = report.initial_cost;
  summary.final_cost = report.final_cost;
  if (!report.IsSolutionUsable()) return;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    if (!problem.fixed[i]) problem.poses[i] = toPose(blocks[i].data());
  }
}

}  // namespace planecloud

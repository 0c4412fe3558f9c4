// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/backend_node/component_join.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>

#include "planecloud_slam/backend_node/closure_comparison.h"
#include "planecloud_slam/backend_node/drift_model.h"
#include "planecloud_slam/backend_node/relative_pose_cost.h"

namespace planecloud {
namespace {

constexpr int kIterations = 10;

/// A closure as a measurement of the pose of one reference keyframe of the moving component in the
/// frame of the other one.
struct AnchorMeasurement {
  Eigen::Isometry3d T_target_anchor = Eigen::Isometry3d::Identity();
  Matrix6d information = Matrix6d::Zero();  ///< at the anchor
};

std::vector<AnchorMeasurement> measureAnchor(const PoseGraph& graph,
                                             const std::vector<GraphEdge>& closures,
                                             const DriftOptions& drift) {
  const int anchor = graph.find(closures.front().to).value();
  std::vector<int> ends;
  for (const GraphEdge& closure : closures) ends.push_back(graph.find(closure.to).value());
  const std::vector<double> paths = graph.pathLengthsTo(anchor, ends);
  std::vector<AnchorMeasurement> measurements;
  for (std::size_t i = 0; i < closures.size(); ++i) {
    const GraphEdge& closure = closures[i];
    const int to = ends[i];
    const Eigen::Isometry3d& T_target_from = graph.pose(graph.find(closure.from).value());
    const Eigen::Isometry3d T_to_anchor = graph.pose(to).inverse() * graph.pose(anchor);
    const Matrix6d to_anchor = adjoint(T_to_anchor);
    const double path = std::min(paths[i], 1e3);
    AnchorMeasurement measurement;
    measurement.T_target_anchor = T_target_from * closure.T_from_to * T_to_anchor;
    measurement.information =
        withErrorFloor(to_anchor.transpose() * closure.information * to_anchor,
                       drift.translation_drift * path, drift.rotation_drift * path);
    measurements.push_back(measurement);
  }
  return measurements;
}

Matrix6d totalInformation(const std::vector<AnchorMeasurement>& measurements) {
  Matrix6d total = Matrix6d::Zero();
  for (const AnchorMeasurement& measurement : measurements) total += measurement.information;
  return total;
}

bool isKnown(const Matrix6d& information, const ClosureConsistencyOptions& options) {
  Vector6d scale;  // makes the demanded accuracy one
  scale.head<3>().setConstant(options.join_translation);
  scale.tail<3>().setConstant(options.join_rotation);
  const Matrix6d scaled = scale.asDiagonal() * information * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(scaled, Eigen::EigenvaluesOnly);
  return solver.eigenvalues().minCoeff() >= 1.0;
}

bool isKnownWithoutAnyOne(const std::vector<AnchorMeasurement>& measurements,
                          const ClosureConsistencyOptions& options) {
  const Matrix6d total = totalInformation(measurements);
  return std::all_of(measurements.begin(), measurements.end(),
                     [&](const AnchorMeasurement& measurement) {
                       return isKnown(total - measurement.information, options);
                     });
}

/// Gauss-Newton on the anchor's pose.
Eigen::Isometry3d fitAnchor(const std::vector<AnchorMeasurement>& measurements) {
  const Matrix6d total = totalInformation(measurements);
  Eigen::Isometry3d T_target_anchor = measurements.front().T_target_anchor;
  for (int i = 0; i < kIterations; ++i) {
    Vector6d gradient = Vector6d::Zero();
    for (const AnchorMeasurement& measurement : measurements) {
      gradient +=
          measurement.information * logSe3(measurement.T_target_anchor.inverse() * T_target_anchor);
    }
    const Vector6d step = -total.ldlt().solve(gradient);
    T_target_anchor = T_target_anchor * expSe3(step);
  }
  return T_target_anchor;
}

}  // namespace

std::optional<ComponentJoin> solveComponentJoin(const PoseGraph& graph,
                                                const std::vector<GraphEdge>& closures,
                                                const ClosureConsistencyOptions& options,
                                                const DriftOptions& drift) {
  std::vector<GraphEdge> oriented;
  for (const GraphEdge& closure : closures) {
    const bool forward = graph.component(graph.find(closure.from).value()) <
                         graph.component(graph.find(closure.to).value());
    oriented.push_back(forward ? closure : reversed(closure));
  }
  const std::vector<AnchorMeasurement> measurements = measureAnchor(graph, oriented, drift);
  if (!isKnownWithoutAnyOne(measurements, options)) return std::nullopt;
  const int anchor = graph.find(oriented.front().to).value();
  ComponentJoin join;
  join.target = graph.component(graph.find(oriented.front().from).value());
  join.source = graph.component(anchor);
  join.T_target_source = fitAnchor(measurements) * graph.pose(anchor).inverse();
  return join;
}

}  // namespace planecloud

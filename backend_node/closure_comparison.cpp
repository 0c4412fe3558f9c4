// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/backend_node/closure_comparison.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>
#include <utility>

#include "planecloud_slam/backend_node/drift_model.h"

namespace planecloud {

GraphEdge reversed(const GraphEdge& closure) {
  GraphEdge result = closure;
  std::swap(result.from, result.to);
  result.T_from_to = closure.T_from_to.inverse();
  result.information = invertRelativePoseInformation(closure.T_from_to, closure.information);
  return result;
}

ClosureComparison::ClosureComparison(const PoseGraph& graph, const GraphEdge& closure,
                                     const DriftOptions& drift, double limit)
    : graph_(graph),
      closure_(closure),
      drift_(drift),
      limit_(limit),
      from_(graph.find(closure.from).value()),
      to_(graph.find(closure.to).value()),
      paths_from_(graph.pathLengths(from_, limit)),
      paths_to_(graph.pathLengths(to_, limit)) {}

double ClosureComparison::path(const GraphEdge& other) const {
  GraphEdge turned;  // only its ends count
  turned.from = other.to;
  turned.to = other.from;
  return std::min(longerPath(other), longerPath(turned));
}

std::vector<int> ClosureComparison::neighbours() const {
  std::set<int> found;
  for (std::size_t node = 0; node < paths_from_.size(); ++node) {
    if (paths_from_[node] > limit_) continue;
    for (const int e : graph_.edgesOf(static_cast<int>(node))) {
      const auto position = static_cast<std::size_t>(e);
      if (graph_.edges().kind(position) != EdgeKind::kClosure) continue;
      if (path(graph_.edges()[position]) <= limit_) found.insert(e);
    }
  }
  return {found.begin(), found.end()};
}

double ClosureComparison::longerPath(const GraphEdge& other) const {
  return std::max(paths_from_[static_cast<std::size_t>(graph_.find(other.from).value())],
                  paths_to_[static_cast<std::size_t>(graph_.find(other.to).value())]);
}

double ClosureComparison::loopError(const GraphEdge& other) const {
  const int from = graph_.find(other.from).value();
  const int to = graph_.find(other.to).value();
  const Eigen::Isometry3d T_from_other = graph_.pose(from_).inverse() * graph_.pose(from);
  const Eigen::Isometry3d T_to_other = graph_.pose(to_).inverse() * graph_.pose(to);
  const Eigen::Isometry3d predicted = T_from_other.inverse() * closure_.T_from_to * T_to_other;
  const Matrix6d covariance =
      measurementCovariance(other.information) +
      transformCovariance(T_to_other.inverse(), measurementCovariance(closure_.information)) +
      driftCovariance(paths_to_[static_cast<std::size_t>(to)], drift_) +
      transformCovariance(predicted.inverse(),
                          driftCovariance(paths_from_[static_cast<std::size_t>(from)], drift_));
  return squaredMahalanobis(logSe3(other.T_from_to.inverse() * predicted), covariance);
}

ClosureComparison::Result ClosureComparison::compare(const GraphEdge& other) const {
  const GraphEdge turned = reversed(other);
  const double straight_path = longerPath(other);
  const double turned_path = longerPath(turned);
  const bool turn = turned_path < straight_path;
  Result result;
  result.path = std::min(straight_path, turned_path);
  result.independent = other.from != closure_.from && other.from != closure_.to &&
                       other.to != closure_.from && other.to != closure_.to;
  if (std::isfinite(result.path)) result.distance = loopError(turn ? turned : other);
  return result;
}

}  // namespace planecloud

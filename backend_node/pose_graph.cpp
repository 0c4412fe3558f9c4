// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/backend_node/pose_graph.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <stdexcept>
#include <utility>

#include "planecloud_slam/backend_node/drift_model.h"
#include "planecloud_slam/backend_node/pose_graph_solver.h"
#include "planecloud_slam/backend_node/relative_pose_cost.h"

namespace planecloud {
namespace {

/// A direction counts as observed from this information on [1/m^2, 1/rad^2]: 0.1 m, 0.1 rad.
constexpr double kObserved = 100.0;

/// Of local optimisations, see PoseGraphProblem: the last decimals are left to the optimisation of
/// the whole, which moves what lies around the window as well.
constexpr double kLocalTolerance = 1e-4;

bool observesEverything(const Matrix6d& information) {
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(information, Eigen::EigenvaluesOnly);
  return solver.eigenvalues().minCoeff() >= kObserved;
}

/// Isometry3d inverts by transposing, so rounding errors of a rotation would grow exponentially
/// along a chain of products and inverses.
Eigen::Isometry3d orthonormal(const Eigen::Isometry3d& T) {
  Eigen::Isometry3d result = T;
  result.linear() = Eigen::Quaterniond(T.linear()).normalized().toRotationMatrix();
  return result;
}

std::size_t index(int number) { return static_cast<std::size_t>(number); }

}  // namespace

PoseGraph::PoseGraph(const PoseGraphOptions& options) : options_(options) { options_.check(); }

int PoseGraph::addNode(const KeyframeId& id, const Eigen::Isometry3d& T_map_camera) {
  const int node = size();
  if (!numbers_.emplace(id, node).second) {
    throw std::invalid_argument("keyframe " + toString(id) + " is in the graph already");
  }
  nodes_.push_back({id, {}});
  edges_of_.emplace_back();
  components_.add();
  setPose(node, orthonormal(T_map_camera));
  return node;
}

void PoseGraph::setPose(int node, const Eigen::Isometry3d& T_map_camera) {
  nodes_[index(node)].T_map_camera = T_map_camera;
  places_.place(node, T_map_camera.translation());
}

void PoseGraph::addEdge(const GraphEdge& edge) {
  const std::optional<int> from = find(edge.from);
  const std::optional<int> to = find(edge.to);
  if (!from || !to || *from == *to) {
    throw std::invalid_argument("edge " + toString(edge.from) + " to " + toString(edge.to) +
                                ": add both keyframes first, and not one to itself");
  }
  // Odometry is a way even when the frontend is modest about it: nothing else bounds the drift.
  const bool complete = edge.kind == EdgeKind::kOdometry || observesEverything(edge.information);
  edges_.push_back(edge);
  ends_.push_back({*from, *to, motionLength(edge.T_from_to), complete});
  edges_of_[index(*from)].push_back(static_cast<int>(edges_.size()) - 1);
  edges_of_[index(*to)].push_back(static_cast<int>(edges_.size()) - 1);
  if (std::size_t* counter = counterOf(edge)) ++*counter;
  components_.join(*from, *to);
}

std::size_t* PoseGraph::counterOf(const GraphEdge& edge) {
  if (edge.kind == EdgeKind::kCoplanar) return &coplanar_;
  if (edge.kind != EdgeKind::kClosure) return nullptr;
  return edge.inter_robot ? &closures_inter_ : &closures_intra_;
}

void PoseGraph::eraseEdge(std::size_t edge) {
  if (std::size_t* counter = counterOf(edges_[edge])) --*counter;
  const auto number = static_cast<int>(edge);
  const int last = static_cast<int>(edges_.size()) - 1;
  for (const int end : {ends_[edge].from, ends_[edge].to}) {
    std::vector<int>& edges = edges_of_[index(end)];
    edges.erase(std::find(edges.begin(), edges.end(), number));
  }
  if (number != last) {
    for (const int end : {ends_.back().from, ends_.back().to}) {
      std::vector<int>& edges = edges_of_[index(end)];
      *std::find(edges.begin(), edges.end(), last) = number;
    }
    ends_[edge] = ends_.back();
  }
  edges_.remove(edge);
  ends_.pop_back();
}

std::optional<int> PoseGraph::find(const KeyframeId& id) const {
  const auto found = numbers_.find(id);
  if (found == numbers_.end()) return std::nullopt;
  return found->second;
}

void PoseGraph::moveComponent(int component, const Eigen::Isometry3d& T_new_old) {
  for (const int node : members(component)) setPose(node, orthonormal(T_new_old * pose(node)));
}

double PoseGraph::squaredError(const GraphEdge& edge) const {
  const RelativePoseCost cost(edge.T_from_to, edge.information);
  return cost.residual(pose(numbers_.at(edge.from)), pose(numbers_.at(edge.to))).squaredNorm();
}

std::optional<std::size_t> PoseGraph::worstOfBackend() const {
  std::optional<std::size_t> worst;
  double worst_error = options_.removal_distance;
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    if (!isMadeByBackend(edges_.kind(i))) continue;
    const double error = squaredError(edges_[i]);
    if (error <= worst_error) continue;
    worst_error = error;
    worst = i;
  }
  return worst;
}

void PoseGraph::solve(OptimisationSummary& summary) {
  PoseGraphProblem problem;
  for (const Node& node : nodes_) problem.poses.push_back(node.T_map_camera);
  problem.fixed.assign(nodes_.size(), false);
  for (int i = 0; i < components(); ++i) problem.fixed[index(members(i).front())] = true;
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    problem.edges.push_back({ends_[i].from, ends_[i].to, edges_[i]});
  }
  solvePoseGraph(options_, problem, summary);
  for (int node = 0; node < size(); ++node) setPose(node, problem.poses[index(node)]);
}

OptimisationSummary PoseGraph::optimizeAround(const std::vector<int>& seeds) {
  OptimisationSummary summary;
  PoseGraphProblem problem;
  problem.tolerance = kLocalTolerance;
  const std::vector<int> free = window(seeds);
  std::vector<int> position(nodes_.size(), -1);
  const auto place = [&](int node) {
    if (position[index(node)] < 0) {
      position[index(node)] = static_cast<int>(problem.poses.size());
      problem.poses.push_back(pose(node));
      problem.fixed.push_back(problem.poses.size() > free.size());
    }
    return position[index(node)];
  };
  for (const int node : free) {
    const bool is_root = members(component(node)).front() == node;
    problem.fixed[index(place(node))] = is_root;
  }
  std::vector<bool> taken(edges_.size(), false);
  for (const int node : free) {
    for (const int e : edges_of_[index(node)]) {
      if (taken[index(e)]) continue;
      taken[index(e)] = true;
      const Ends& ends = ends_[index(e)];
      problem.edges.push_back({place(ends.from), place(ends.to), edges_[index(e)]});
    }
  }
  if (problem.edges.empty()) return summary;
  solvePoseGraph(options_, problem, summary);
  for (const int node : free) {
    setPose(node, problem.poses[index(position[index(node)])]);
  }
  return summary;
}

std::vector<GraphEdge> PoseGraph::adopt(const PoseGraph& copy, const OptimisationSummary& summary) {
  // A component of the copy may have moved as a whole since; its root is where it was in the copy.
  std::vector<Eigen::Isometry3d> corrections;  // T_map_new_old of every node
  for (int node = 0; node < copy.size(); ++node) {
    const int root = copy.members(copy.component(node)).front();
    const Eigen::Isometry3d T_now_copy = pose(root) * copy.pose(root).inverse();
    corrections.push_back(T_now_copy * copy.pose(node) * pose(node).inverse());
  }
  for (int node = copy.size(); node < size(); ++node) {
    int anchor = node;
    for (const int e : edges_of_[index(node)]) {
      if (isMadeByBackend(edges_.kind(index(e)))) continue;
      anchor = std::min(anchor, ends_[index(e)].opposite(node));
    }
    corrections.push_back(anchor < node ? corrections[index(anchor)]
                                        : Eigen::Isometry3d::Identity());
  }
  for (int node = 0; node < size(); ++node) {
    setPose(node, orthonormal(corrections[index(node)] * pose(node)));
  }
  std::vector<GraphEdge> removed;
  for (const GraphEdge& gone : summary.removed) {
    for (const int e : edges_of_[index(numbers_.at(gone.from))]) {
      const GraphEdge edge = edges_[index(e)];
      if (edge.kind != gone.kind || edge.from != gone.from || edge.to != gone.to) continue;
      removed.push_back(edge);
      eraseEdge(index(e));
      break;
    }
  }
  if (!removed.empty()) findComponents();
  return removed;
}

OptimisationSummary PoseGraph::optimize() {
  OptimisationSummary summary;
  if (edges_.empty()) return summary;
  solve(summary);
  while (const std::optional<std::size_t> worst = worstOfBackend()) {
    summary.removed.push_back(edges_[*worst]);
    eraseEdge(*worst);
    findComponents();
    solve(summary);
  }
  return summary;
}

}  // namespace planecloud

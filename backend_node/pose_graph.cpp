// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/backend_node/pose_graph.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <functional>
#include <limits>
#include <queue>
#include <stdexcept>
#include <utility>

#include "planecloud_slam/backend_node/drift_model.h"
#include "planecloud_slam/backend_node/pose_graph_solver.h"
#include "planecloud_slam/backend_node/relative_pose_cost.h"

namespace planecloud {
namespace {

/// A direction counts as observed from this information on [1/m^2, 1/rad^2]: 0.1 m, 0.1 rad.
constexpr double kObserved = 100.0;

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
  if (!numbers_.emplace(id, size()).second) {
    throw std::invalid_argument("keyframe " + toString(id) + " is in the graph already");
  }
  nodes_.push_back({id, orthonormal(T_map_camera), components_++});
  edges_of_.emplace_back();
  return size() - 1;
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
  if (component(*from) != component(*to)) renumberComponents();
}

void PoseGraph::eraseEdge(std::size_t edge) {
  const auto offset = static_cast<std::ptrdiff_t>(edge);
  edges_.erase(edges_.begin() + offset);
  ends_.erase(ends_.begin() + offset);
  for (std::vector<int>& edges : edges_of_) edges.clear();
  for (std::size_t i = 0; i < ends_.size(); ++i) {
    edges_of_[index(ends_[i].from)].push_back(static_cast<int>(i));
    edges_of_[index(ends_[i].to)].push_back(static_cast<int>(i));
  }
}

std::optional<int> PoseGraph::find(const KeyframeId& id) const {
  const auto found = numbers_.find(id);
  if (found == numbers_.end()) return std::nullopt;
  return found->second;
}

void PoseGraph::moveComponent(int component, const Eigen::Isometry3d& T_new_old) {
  for (Node& node : nodes_) {
    if (node.component != component) continue;
    node.T_map_camera = orthonormal(T_new_old * node.T_map_camera);
  }
}

void PoseGraph::renumberComponents() {
  for (Node& node : nodes_) node.component = -1;
  components_ = 0;
  for (int root = 0; root < size(); ++root) {
    if (component(root) >= 0) continue;
    std::vector<int> open{root};
    nodes_[index(root)].component = components_;
    while (!open.empty()) {
      const int node = open.back();
      open.pop_back();
      for (const int e : edges_of_[index(node)]) {
        const Ends& ends = ends_[index(e)];
        const int next = ends.from == node ? ends.to : ends.from;
        if (component(next) >= 0) continue;
        nodes_[index(next)].component = components_;
        open.push_back(next);
      }
    }
    ++components_;
  }
}

std::vector<double> PoseGraph::pathLengths(int node) const {
  std::vector<double> lengths(nodes_.size(), std::numeric_limits<double>::infinity());
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  lengths.at(index(node)) = 0.0;
  open.emplace(0.0, node);
  while (!open.empty()) {
    const auto [length, current] = open.top();
    open.pop();
    if (length > lengths[index(current)]) continue;
    for (const int e : edges_of_[index(current)]) {
      const Ends& ends = ends_[index(e)];
      if (!ends.complete) continue;
      const int next = ends.from == current ? ends.to : ends.from;
      if (length + ends.length >= lengths[index(next)]) continue;
      lengths[index(next)] = length + ends.length;
      open.emplace(lengths[index(next)], next);
    }
  }
  return lengths;
}

double PoseGraph::squaredError(const GraphEdge& edge) const {
  const RelativePoseCost cost(edge.T_from_to, edge.information);
  return cost.residual(pose(numbers_.at(edge.from)), pose(numbers_.at(edge.to))).squaredNorm();
}

std::optional<std::size_t> PoseGraph::worstClosure() const {
  std::optional<std::size_t> worst;
  double worst_error = options_.removal_distance;
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    if (edges_[i].kind != EdgeKind::kClosure) continue;
    const double error = squaredError(edges_[i]);
    if (error <= worst_error) continue;
    worst_error = error;
    worst = i;
  }
  return worst;
}

std::vector<int> PoseGraph::rootsOfComponents() const {
  std::vector<int> roots(index(components_), -1);
  for (int node = 0; node < size(); ++node) {
    int& root = roots[index(component(node))];
    if (root < 0) root = node;
  }
  return roots;
}

std::vector<int> PoseGraph::nodesAround(const std::vector<int>& seeds) const {
  std::vector<bool> seen(nodes_.size(), false);
  std::vector<int> nodes;
  const auto visit = [&](int node) {
    if (seen[index(node)] || static_cast<int>(nodes.size()) >= options_.local_window) return;
    seen[index(node)] = true;
    nodes.push_back(node);
  };
  for (const int seed : seeds) visit(seed);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    for (const int e : edges_of_[index(nodes[i])]) {
      visit(ends_[index(e)].from);
      visit(ends_[index(e)].to);
    }
  }
  return nodes;
}

void PoseGraph::solve(OptimisationSummary& summary) {
  PoseGraphProblem problem;
  for (const Node& node : nodes_) problem.poses.push_back(node.T_map_camera);
  problem.fixed.assign(nodes_.size(), false);
  for (const int root : rootsOfComponents()) problem.fixed[index(root)] = true;
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    problem.edges.push_back({ends_[i].from, ends_[i].to, &edges_[i]});
  }
  solvePoseGraph(options_, problem, summary);
  for (std::size_t i = 0; i < nodes_.size(); ++i) nodes_[i].T_map_camera = problem.poses[i];
}

OptimisationSummary PoseGraph::optimizeAround(const std::vector<int>& seeds) {
  OptimisationSummary summary;
  PoseGraphProblem problem;
  std::vector<int> window = nodesAround(seeds);
  const std::size_t free_nodes = window.size();
  std::vector<int> position(nodes_.size(), -1);
  const auto place = [&](int node) {
    if (position[index(node)] < 0) {
      position[index(node)] = static_cast<int>(problem.poses.size());
      problem.poses.push_back(pose(node));
      problem.fixed.push_back(problem.poses.size() > free_nodes);
    }
    return position[index(node)];
  };
  for (const int node : window) place(node);
  for (const int root : rootsOfComponents()) {
    if (position[index(root)] >= 0) problem.fixed[index(position[index(root)])] = true;
  }
  std::vector<bool> taken(edges_.size(), false);
  for (const int node : window) {
    for (const int e : edges_of_[index(node)]) {
      if (taken[index(e)]) continue;
      taken[index(e)] = true;
      const Ends& ends = ends_[index(e)];
      problem.edges.push_back({place(ends.from), place(ends.to), &edges_[index(e)]});
    }
  }
  if (problem.edges.empty()) return summary;
  solvePoseGraph(options_, problem, summary);
  for (const int node : window) {
    nodes_[index(node)].T_map_camera = problem.poses[index(position[index(node)])];
  }
  return summary;
}

std::vector<GraphEdge> PoseGraph::adopt(const PoseGraph& copy, const OptimisationSummary& summary) {
  // A component of the copy may have moved as a whole since; its root is where it was in the copy.
  const std::vector<int> roots = copy.rootsOfComponents();
  std::vector<Eigen::Isometry3d> corrections;  // T_map_new_old of every node
  for (int node = 0; node < copy.size(); ++node) {
    const int root = roots[index(copy.component(node))];
    const Eigen::Isometry3d T_now_copy = pose(root) * copy.pose(root).inverse();
    corrections.push_back(T_now_copy * copy.pose(node) * pose(node).inverse());
  }
  for (int node = copy.size(); node < size(); ++node) {
    int anchor = node;
    for (const int e : edges_of_[index(node)]) {
      anchor = std::min({anchor, ends_[index(e)].from, ends_[index(e)].to});
    }
    corrections.push_back(anchor < node ? corrections[index(anchor)]
                                        : Eigen::Isometry3d::Identity());
  }
  for (int node = 0; node < size(); ++node) {
    nodes_[index(node)].T_map_camera = orthonormal(corrections[index(node)] * pose(node));
  }
  std::vector<GraphEdge> removed;
  for (const GraphEdge& gone : summary.removed) {
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      const bool same = edges_[i].kind == EdgeKind::kClosure && edges_[i].from == gone.from &&
                        edges_[i].to == gone.to;
      if (!same) continue;
      removed.push_back(edges_[i]);
      eraseEdge(i);
      break;
    }
  }
  if (!removed.empty()) renumberComponents();
  return removed;
}

OptimisationSummary PoseGraph::optimize() {
  OptimisationSummary summary;
  if (edges_.empty()) return summary;
  solve(summary);
  while (const std::optional<std::size_t> worst = worstClosure()) {
    summary.removed.push_back(edges_[*worst]);
    eraseEdge(*worst);
    renumberComponents();
    solve(summary);
  }
  return summary;
}

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "planecloud_slam/backend_node/closure_consistency.h"
#include "planecloud_slam/backend_node/drift_model.h"
#include "planecloud_slam/backend_node/pose_graph.h"
#include "synthetic_robot.h"

namespace planecloud {

/// Three rounds through the hall with odometry that drifts; closures of which a share is false:
/// half of those at random, half in mutually consistent groups of five, as a place that looks like
/// another one makes them.
struct FalseClosureTrial {
  double false_share = 0.0;
  unsigned seed = 1;
};

struct FalseClosureResult {
  double ate = 0.0;  ///< RMS distance to the truth, starts aligned [m]
  int offered_false = 0;
  int offered_true = 0;
  int kept_false = 0;  ///< in the graph at the end
  int kept_true = 0;
};

namespace false_closures {

constexpr double kSpacing = 0.25;  // of keyframes [m]
constexpr double kRounds = 3.0;
constexpr std::size_t kGroup = 5;
constexpr std::size_t kOptimiseEvery = 20;  // keyframes

struct Offer {
  std::size_t from = 0;
  std::size_t to = 0;
  Eigen::Isometry3d T_from_to = Eigen::Isometry3d::Identity();
  bool is_false = false;
};

inline Eigen::Isometry3d noise(double translation, double rotation, std::mt19937& random) {
  std::normal_distribution<double> gauss;
  Vector6d xi;
  for (int i = 0; i < 6; ++i) xi(i) = (i < 3 ? translation : rotation) * gauss(random);
  return expSe3(xi);
}

inline std::vector<Eigen::Isometry3d> truePoses() {
  std::vector<Eigen::Isometry3d> poses;
  for (double way = 0.0; way < kRounds * kHallRound; way += kSpacing) {
    poses.push_back(hallPose(way));
  }
  return poses;
}

/// A true closure for every second keyframe of the later rounds, to the same place a round before.
inline std::vector<Offer> trueOffers(const std::vector<Eigen::Isometry3d>& truth,
                                     std::mt19937& random) {
  const auto round = static_cast<std::size_t>(kHallRound / kSpacing);
  std::vector<Offer> offers;
  for (std::size_t to = round; to < truth.size(); to += 2) {
    const std::size_t from = to - round;
    offers.push_back(
        {from, to, truth[from].inverse() * truth[to] * noise(0.015, 0.01, random), false});
  }
  return offers;
}

/// Replaces a share of the offers.
inline void falsify(const std::vector<Eigen::Isometry3d>& truth, double share, std::mt19937& random,
                    std::vector<Offer>& offers) {
  const auto count = static_cast<std::size_t>(share * static_cast<double>(offers.size()));
  const std::size_t groups = count / 2 / kGroup;
  std::uniform_int_distribution<std::size_t> any(0, offers.size() - 1);
  std::size_t replaced = 0;
  for (int tries = 0; replaced < groups * kGroup && tries < 1000; ++tries) {
    const std::size_t first = any(random) / kGroup * kGroup;
    if (first + kGroup > offers.size() || offers[first].is_false) continue;
    std::uniform_int_distribution<std::size_t> place(0, offers[first].from);
    const std::size_t wrong = place(random);
    // All of the group claim that this stretch lies over another one.
    const Eigen::Isometry3d T_wrong_right =
        truth[wrong] * noise(0.1, 0.05, random) * truth[offers[first].to].inverse();
    for (std::size_t i = first; i < first + kGroup; ++i) {
      Offer& offer = offers[i];
      offer.from = wrong + 2 * (i - first);
      offer.T_from_to = truth[offer.from].inverse() * T_wrong_right * truth[offer.to] *
                        noise(0.015, 0.01, random);
      offer.is_false = true;
    }
    replaced += kGroup;
  }
  while (replaced < count) {
    Offer& offer = offers[any(random)];
    if (offer.is_false) continue;
    std::uniform_int_distribution<std::size_t> place(0, offer.from);
    offer.from = place(random);
    offer.T_from_to = noise(0.5, 0.3, random);
    offer.is_false = true;
    ++replaced;
  }
}

inline KeyframeId idOf(std::size_t number) {
  return {"robot", 1, static_cast<std::uint32_t>(number)};
}

inline GraphEdge edgeOf(EdgeKind kind, const Offer& offer, double translation, double rotation) {
  GraphEdge edge;
  edge.kind = kind;
  edge.from = idOf(offer.from);
  edge.to = idOf(offer.to);
  edge.T_from_to = offer.T_from_to;
  edge.information.topLeftCorner<3, 3>().diagonal().setConstant(1.0 / (translation * translation));
  edge.information.bottomRightCorner<3, 3>().diagonal().setConstant(1.0 / (rotation * rotation));
  return edge;
}

}  // namespace false_closures

/// Runs the part of the backend that a verified closure meets: agreement with odometry, pairwise
/// consistency, the robust graph, removal of what is found false.
inline FalseClosureResult runFalseClosures(const FalseClosureTrial& trial,
                                           const BackendOptions& options = BackendOptions()) {
  using namespace false_closures;
  std::mt19937 random(trial.seed);
  const std::vector<Eigen::Isometry3d> truth = truePoses();
  std::vector<Offer> offers = trueOffers(truth, random);
  falsify(truth, trial.false_share, random, offers);
  std::mt19937 odometry(trial.seed + 1000);  // the same whatever is replaced
  const DriftOptions& drift = options.loop_closure.drift;
  PoseGraph graph(options.graph);
  ClosureConsistency consistency(options.loop_closure.consistency, drift);
  FalseClosureResult result;
  std::size_t next = 0;
  graph.addNode(idOf(0), truth[0]);
  for (std::size_t i = 1; i < truth.size(); ++i) {
    const Offer step{i - 1, i, truth[i - 1].inverse() * truth[i] * noise(0.004, 0.003, odometry)};
    graph.addNode(idOf(i), graph.pose(static_cast<int>(i) - 1) * step.T_from_to);
    graph.addEdge(edgeOf(EdgeKind::kOdometry, step, 0.004, 0.003));
    for (; next < offers.size() && offers[next].to == i; ++next) {
      const Offer& offer = offers[next];
      ++(offer.is_false ? result.offered_false : result.offered_true);
      const GraphEdge closure = edgeOf(EdgeKind::kClosure, offer, 0.02, 0.015);
      const int from = static_cast<int>(offer.from);
      const Eigen::Isometry3d guess = graph.pose(from).inverse() * graph.pose(static_cast<int>(i));
      const double path = graph.pathLengths(static_cast<int>(i))[offer.from];
      const double distance = squaredMahalanobis(
          logSe3(offer.T_from_to.inverse() * guess),
          driftCovariance(path, drift) + measurementCovariance(closure.information));
      if (distance > options.loop_closure.verification.max_inconsistency) continue;
      const ClosureAdmission admission = consistency.offer(
          graph, closure, [](const ComponentJoin&, const std::vector<GraphEdge>&) { return true; });
      for (const GraphEdge& accepted : admission.closures) graph.addEdge(accepted);
    }
    if (i % kOptimiseEvery == 0) graph.optimize();
  }
  graph.optimize();
  double sum = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    sum += (graph.pose(static_cast<int>(i)).translation() - truth[i].translation()).squaredNorm();
  }
  result.ate = std::sqrt(sum / static_cast<double>(truth.size()));
  for (const GraphEdge& edge : graph.edges()) {
    if (edge.kind != EdgeKind::kClosure) continue;
    const Eigen::Isometry3d T_true = truth[edge.from.number].inverse() * truth[edge.to.number];
    const Eigen::Isometry3d error = T_true.inverse() * edge.T_from_to;
    const bool is_false = error.translation().norm() > 0.1 || rotationAngle(error) > 0.0524;
    ++(is_false ? result.kept_false : result.kept_true);
  }
  return result;
}

}  // namespace planecloud

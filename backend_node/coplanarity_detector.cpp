// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/backend_node/coplanarity_detector.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "planecloud_slam/backend_node/drift_model.h"
#include "planecloud_slam/backend_node/view_overlap.h"

namespace planecloud {
namespace {

/// Standard deviations within which another parallel surface makes a pair ambiguous.
constexpr double kGate = 3.0;

/// Between normals of surfaces that are compared at all [rad].
constexpr double kLargestTilt = 0.5;

/// Own path over which odometry tells surfaces apart that lie a little in front of each other [m].
constexpr double kLookBack = 1.5;
constexpr double kToldApart = 0.03;  ///< over that path, beside the noise of the planes [m]
/// Squared Mahalanobis distance up to which two keyframes see the same plane there.
constexpr double kAlike = 3.0;

/// A point this far behind a surface was seen through it [m]; points allowed of those in a sketch.
constexpr double kBehind = 0.15;
constexpr int kMostSeenThrough = 1;

std::size_t indexOf(int node) { return static_cast<std::size_t>(node); }

bool parallel(const FlatSurface& target, const FlatSurface& source,
              const Eigen::Isometry3d& T_target_source) {
  const double cosine = target.normal.dot(T_target_source.linear() * source.normal);
  return cosine > std::cos(kLargestTilt);
}

FlatSurface moved(const FlatSurface& surface, const Eigen::Isometry3d& T) {
  FlatSurface result = surface;
  result.normal = T.linear() * surface.normal;
  result.centroid = T * surface.centroid;
  result.axes = T.linear() * surface.axes;
  return result;
}

/// Tells surfaces of keyframes a little way apart what they are to each other.
void compareNear(const Eigen::Isometry3d& T_earlier_later, FlatSurface& earlier,
                 FlatSurface& later) {
  if (!parallel(earlier, later, T_earlier_later)) return;
  const Coplanarity pair = compareSurfaces(earlier, later, T_earlier_later);
  const double height = std::abs(pair.residual(0));
  if (height > kToldApart + kGate * std::sqrt(pair.covariance(0, 0))) {
    earlier.clearance = std::min(earlier.clearance, height);
    later.clearance = std::min(later.clearance, height);
  } else if (squaredMahalanobis(pair.residual, pair.covariance) < kAlike) {
    earlier.confirmed = true;
    later.confirmed = true;
  }
}

/// Whether a keyframe saw points behind `surface`, which is given in its frame, through it.
bool seesThrough(const ViewSketch& sketch, const FlatSurface& surface) {
  const double d = -surface.normal.dot(surface.centroid);
  int behind = 0;
  for (const ViewSketch::Sample& sample : sketch.samples) {
    const Eigen::Vector3d point = sample.point.cast<double>();
    const double height = surface.normal.dot(point) + d;
    if (d <= 0.0 || height > -kBehind) continue;
    const Eigen::Vector3d met = point * (d / (d - height));
    const Eigen::Vector2d place = surface.axes.transpose() * (met - surface.centroid);
    if ((place.cwiseAbs().array() < surface.half_sides.array()).all()) ++behind;
  }
  return behind > kMostSeenThrough;
}

}  // namespace

std::vector<GraphEdge> CoplanarityDetector::detect(const PoseGraph& graph,
                                                   const KeyframeRecords& records, int source,
                                                   const PlaneCloud& planes) {
  surfaces_.resize(records.size());
  surfaces_[indexOf(source)] = findFlatSurfaces(planes, options_.coplanarity.min_area, icap_);
  const Query query{graph, records, source};
  lookBack(query);
  std::vector<Candidate> candidates = propose(query);
  candidates.erase(std::remove_if(candidates.begin(), candidates.end(),
                                  [&](Candidate& candidate) { return !judge(query, candidate); }),
                   candidates.end());
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.gain > b.gain; });
  std::vector<GraphEdge> edges;
  std::set<const FlatSurface*> ends;  // of the source: each makes one edge at most
  for (Candidate& candidate : candidates) {
    if (static_cast<int>(edges.size()) == options_.coplanarity.max_edges) break;
    if (candidate.target_surface->taken || !ends.insert(candidate.source_surface).second) continue;
    candidate.target_surface->taken = true;
    edges.push_back(std::move(candidate.edge));
  }
  return edges;
}

void CoplanarityDetector::lookBack(const Query& query) {
  const KeyframeRecord& source = query.records[indexOf(query.source)];
  std::vector<FlatSurface>& own = surfaces_[indexOf(query.source)];
  auto at = query.graph.numbers().find(source.keyframe->id);
  while (at != query.graph.numbers().begin()) {
    const auto& [id, node] = *--at;
    const KeyframeRecord& other = query.records[indexOf(node)];
    const bool same = sameSession(id, source.keyframe->id);
    if (!same || source.path - other.path > kLookBack) return;
    if (query.graph.component(node) != query.graph.component(query.source)) return;
    const Eigen::Isometry3d T_other_source =
        query.graph.pose(node).inverse() * query.graph.pose(query.source);
    for (FlatSurface& earlier : surfaces_[indexOf(node)]) {
      for (FlatSurface& surface : own) compareNear(T_other_source, earlier, surface);
    }
  }
}

bool CoplanarityDetector::mayPair(const Query& query, int target) const {
  if (query.graph.component(target) != query.graph.component(query.source)) return false;
  if (surfaces_[indexOf(target)].empty()) return false;
  return isRevisit(query.records[indexOf(target)], query.records[indexOf(query.source)],
                   options_.candidates.min_path_gap);
}

std::vector<CoplanarityDetector::Candidate> CoplanarityDetector::propose(const Query& query) {
  const std::vector<FlatSurface>& own = surfaces_[indexOf(query.source)];
  std::vector<Candidate> candidates;
  if (own.empty()) return candidates;
  std::vector<int> targets;
  for (const int target :
       query.graph.nodesAround(query.source, options_.coplanarity.max_distance)) {
    if (target != query.source && mayPair(query, target)) targets.push_back(target);
  }
  if (targets.empty()) return candidates;
  const double limit = options_.coplanarity.max_path;
  const std::vector<double> paths = query.graph.pathLengths(query.source, limit);
  for (const int node : targets) {
    const double path = paths[indexOf(node)];
    for (FlatSurface& target : surfaces_[indexOf(node)]) {
      if (target.taken) continue;
      for (const FlatSurface& source : own) {
        const bool sure = path <= limit && target.confirmed && source.confirmed;
        if (sure) candidates.push_back({node, &target, &source, path, 0.0, {}});
      }
    }
  }
  return candidates;
}

bool CoplanarityDetector::judge(const Query& query, Candidate& candidate) const {
  const FlatSurface& target = *candidate.target_surface;
  const FlatSurface& source = *candidate.source_surface;
  const Eigen::Isometry3d predicted =
      query.graph.pose(candidate.target).inverse() * query.graph.pose(query.source);
  const double distance = (predicted * source.centroid - target.centroid).norm();
  if (!parallel(target, source, predicted)) return false;
  if (distance > options_.coplanarity.max_distance) return false;
  const Coplanarity pair = compareSurfaces(target, source, predicted);
  const Matrix6d drift = driftCovariance(candidate.path, options_.drift);
  const Eigen::Matrix3d covariance =
      pair.jacobian * drift * pair.jacobian.transpose() + pair.covariance;
  if (squaredMahalanobis(pair.residual, covariance) > options_.coplanarity.max_inconsistency) {
    return false;
  }
  const double unknown = kGate * std::sqrt(covariance(0, 0)) + std::abs(pair.residual(0));
  if (std::min(target.clearance, source.clearance) < unknown) return false;
  const Eigen::Isometry3d T_target_source = predicted * expSe3(makeCoplanar(pair, drift));
  if (!viewsAllow(query, candidate, T_target_source)) return false;
  const Coplanarity fitted = compareSurfaces(target, source, T_target_source);
  candidate.gain = std::log(covariance.determinant() / fitted.covariance.determinant());
  candidate.edge = makeEdge(query, candidate, T_target_source, fitted);
  return true;
}

bool CoplanarityDetector::viewsAllow(const Query& query, const Candidate& candidate,
                                     const Eigen::Isometry3d& T_target_source) const {
  const ViewSketch& target = query.records[indexOf(candidate.target)].sketch;
  const ViewSketch& source = query.records[indexOf(query.source)].sketch;
  if (mutualViewOverlap(target, source, T_target_source) >= options_.candidates.min_view_overlap) {
    return false;  // a matter of loop closures
  }
  return !seesThrough(target, moved(*candidate.source_surface, T_target_source)) &&
         !seesThrough(source, moved(*candidate.target_surface, T_target_source.inverse()));
}

GraphEdge CoplanarityDetector::makeEdge(const Query& query, const Candidate& candidate,
                                        const Eigen::Isometry3d& T_target_source,
                                        const Coplanarity& fitted) {
  GraphEdge edge;
  edge.kind = EdgeKind::kCoplanar;
  edge.from = query.graph.id(candidate.target);
  edge.to = query.graph.id(query.source);
  edge.T_from_to = T_target_source;
  edge.information = informationOf(fitted);
  edge.inter_robot = edge.from.robot != edge.to.robot;
  return edge;
}

}  // namespace planecloud

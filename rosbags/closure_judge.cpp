// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/rosbags/closure_judge.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "planecloud_slam/plane_fit/se3.h"
#include "planecloud_slam/rosbags/trajectory_evaluation.h"
#include "planecloud_slam/rosbags/view_samples.h"

namespace planecloud {
namespace {

constexpr double kTranslationLimit = 0.1;              // [m]
constexpr double kRotationLimit = 3.0 * M_PI / 180.0;  // [rad]
constexpr double kLeastInformation = 1.0 / (10 * 10);  // of an error in units of the limits
constexpr double kPartnerAge = 10.0;                   // [s]
constexpr double kPartnerOverlap = 0.5;

/// A keyframe of the map with its true pose and what it sees.
struct TrueKeyframe {
  KeyframeId id;
  double stamp = 0.0;
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  ViewSamples view;
};

std::vector<TrueKeyframe> findTrueKeyframes(const MapSnapshot& map,
                                            const std::vector<RobotTruth>& truths) {
  std::vector<TrueKeyframe> keyframes;
  for (const MapSnapshot::Node& node : map.nodes) {
    const MapKeyframe& keyframe = *node.keyframe;
    const auto truth = std::find_if(truths.begin(), truths.end(), [&](const RobotTruth& t) {
      return t.robot == keyframe.id.robot;
    });
    if (truth == truths.end()) continue;
    const auto pose = poseAt(truth->trajectory, keyframe.stamp);
    if (!pose) continue;
    keyframes.push_back({keyframe.id, keyframe.stamp, *pose, ViewSamples(*keyframe.planes)});
  }
  return keyframes;
}

bool mayBePartner(const TrueKeyframe& keyframe, const TrueKeyframe& other) {
  if (keyframe.id.robot != other.id.robot) return true;
  return other.stamp < keyframe.stamp - kPartnerAge;
}

bool overlap(const TrueKeyframe& a, const TrueKeyframe& b) {
  const Eigen::Isometry3d T_a_b = a.T_world_camera.inverse() * b.T_world_camera;
  return b.view.shareSeenBy(a.view, T_a_b) >= kPartnerOverlap &&
         a.view.shareSeenBy(b.view, T_a_b.inverse()) >= kPartnerOverlap;
}

std::set<KeyframeId> findKeyframesWithPartner(const std::vector<TrueKeyframe>& keyframes) {
  std::set<KeyframeId> found;
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const TrueKeyframe& a = keyframes[i];
      const TrueKeyframe& b = keyframes[j];
      const bool a_wants = mayBePartner(a, b) && found.count(a.id) == 0;
      const bool b_wants = mayBePartner(b, a) && found.count(b.id) == 0;
      if ((!a_wants && !b_wants) || !overlap(a, b)) continue;
      if (a_wants) found.insert(a.id);
      if (b_wants) found.insert(b.id);
    }
  }
  return found;
}

}  // namespace

ClosureTruth judgeClosure(const GraphEdge& closure, const Eigen::Isometry3d& T_from_to_truth) {
  const Eigen::Isometry3d T_error = closure.T_from_to.inverse() * T_from_to_truth;
  Vector6d limits;
  limits << Eigen::Vector3d::Constant(kTranslationLimit), Eigen::Vector3d::Constant(kRotationLimit);
  // Translation and rotation apart: a long way along an unobserved axis must not leak through a
  // small rotation into the directions across, as it would in Log.
  Vector6d error;
  error << T_error.translation(), logSo3(Eigen::Quaterniond(T_error.linear()).normalized());
  const Vector6d scaled_error = error.cwiseQuotient(limits);
  const Matrix6d scaled_information =
      limits.asDiagonal() * closure.information * limits.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(scaled_information);
  Vector6d known = Vector6d::Zero();
  for (int i = 0; i < 6; ++i) {
    if (eigen.eigenvalues()(i) < kLeastInformation) continue;
    const Vector6d direction = eigen.eigenvectors().col(i);
    known += direction * direction.dot(scaled_error);
  }
  const bool wrong = known.head<3>().norm() > 1.0 || known.tail<3>().norm() > 1.0;
  return wrong ? ClosureTruth::kFalse : ClosureTruth::kTrue;
}

ClosureJudgement judgeClosures(const MapSnapshot& map, const std::vector<RobotTruth>& truths) {
  const std::vector<TrueKeyframe> keyframes = findTrueKeyframes(map, truths);
  std::map<KeyframeId, Eigen::Isometry3d> poses;
  for (const TrueKeyframe& keyframe : keyframes) poses[keyframe.id] = keyframe.T_world_camera;

  ClosureJudgement judgement;
  std::set<KeyframeId> closed;
  for (const GraphEdge& edge : map.edges) {
    if (edge.kind != EdgeKind::kClosure) continue;
    JudgedClosure judged;
    judged.edge = edge;
    const auto from = poses.find(edge.from);
    const auto to = poses.find(edge.to);
    if (from != poses.end() && to != poses.end()) {
      judged.verdict = judgeClosure(edge, from->second.inverse() * to->second);
    }
    if (judged.verdict == ClosureTruth::kFalse) ++judgement.false_closures;
    if (judged.verdict == ClosureTruth::kTrue) closed.insert({edge.from, edge.to});
    judgement.closures.push_back(std::move(judged));
  }
  for (const KeyframeId& id : findKeyframesWithPartner(keyframes)) {
    ++judgement.possible;
    if (closed.count(id) != 0) ++judgement.found;
  }
  return judgement;
}

}  // namespace planecloud

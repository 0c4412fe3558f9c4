// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/backend_node/keyframe_check.h"

#include <Eigen/Eigenvalues>
#include <exception>
#include <set>
#include <sstream>

#include "planecloud_slam/plane_fit/plane_cloud_codec.h"

namespace planecloud {
namespace {

/// Poses and information travel as float32.
constexpr double kOrthonormal = 1e-4;
constexpr double kRelativeRounding = 1e-5;

/// No robot drives this far from its start [m]; a corrupt float does.
constexpr double kLargestDistance = 1e5;

/// Stamps are unsigned 32-bit seconds since the epoch in ROS.
constexpr double kLargestStamp = 4294967296.0;

bool isRigid(const Eigen::Isometry3d& T) {
  if (!T.matrix().allFinite()) return false;
  const Eigen::Matrix3d R = T.linear();
  return (R.transpose() * R - Eigen::Matrix3d::Identity()).norm() < kOrthonormal &&
         R.determinant() > 0.0 && T.translation().norm() < kLargestDistance;
}

bool isInformation(const Matrix6d& information) {
  if (!information.allFinite()) return false;
  const double tolerance = kRelativeRounding * information.cwiseAbs().maxCoeff();
  if ((information - information.transpose()).cwiseAbs().maxCoeff() > tolerance) return false;
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(information, Eigen::EigenvaluesOnly);
  return solver.eigenvalues().minCoeff() >= -6.0 * tolerance;
}

std::string checkIdentity(const Keyframe& keyframe) {
  if (keyframe.id.robot.empty()) return "the robot has no name; set the frontend's robot name";
  if (!(keyframe.stamp >= 0.0 && keyframe.stamp < kLargestStamp)) {
    std::ostringstream text;
    text << "stamp " << keyframe.stamp << " s is not in [0, 2^32); check the camera driver's clock";
    return text.str();
  }
  if (!isRigid(keyframe.T_odom_camera)) {
    return "the odometry pose is not a finite rigid transform; restart the frontend";
  }
  return "";
}

std::string checkEdge(const KeyframeId& id, const RelativePoseEdge& edge) {
  const std::string name = "edge to " + toString(edge.other);
  if (edge.other.robot.empty()) return name + ": the robot has no name";
  if (edge.other == id) return name + ": a keyframe cannot have an edge to itself";
  if (edge.other.robot == id.robot && edge.other.session == id.session && id < edge.other) {
    return name + ": a keyframe cannot know a later one of its own session";
  }
  if (!isRigid(edge.T_other_this)) return name + ": the pose is not a finite rigid transform";
  if (!isInformation(edge.information)) {
    return name + ": the information is not finite, symmetric and positive semi-definite";
  }
  return "";
}

std::string checkEdges(const Keyframe& keyframe) {
  std::set<KeyframeId> others;
  for (const RelativePoseEdge& edge : keyframe.edges) {
    std::string reason = checkEdge(keyframe.id, edge);
    if (!reason.empty()) return reason;
    if (!others.insert(edge.other).second) {
      return "edge to " + toString(edge.other) + " is there twice";
    }
  }
  return "";
}

}  // namespace

KeyframeCheck checkKeyframe(const Keyframe& keyframe) {
  std::string reason = checkIdentity(keyframe);
  if (reason.empty()) reason = checkEdges(keyframe);
  KeyframeCheck check;
  if (reason.empty()) {
    try {
      check.planes = std::make_shared<const PlaneCloud>(decode(keyframe.planes));
    } catch (const std::exception& error) {
      reason = std::string("its planes cannot be decoded: ") + error.what();
    }
  }
  if (!reason.empty()) check.reason = "keyframe " + toString(keyframe.id) + " refused: " + reason;
  return check;
}

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/rosbags/trajectory_evaluation.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "planecloud_slam/plane_fit/se3.h"

namespace planecloud {
namespace {

constexpr double kSameStamp = 1e-5;         // [s]: files are written to the microsecond
constexpr double kRelativeInterval = 1.0;   // [s]
constexpr double kIntervalTolerance = 0.1;  // [s]
constexpr double kStartInterval = 1.0;      // [s]

/// Root mean square of what is added.
class RootMeanSquare {
 public:
  void add(double value) {
    sum_ += value * value;
    ++count_;
  }
  [[nodiscard]] double value() const {
    if (count_ == 0) return std::numeric_limits<double>::quiet_NaN();
    return std::sqrt(sum_ / static_cast<double>(count_));
  }

 private:
  double sum_ = 0.0;
  std::size_t count_ = 0;
};

bool earlier(const StampedPose& pose, double stamp) { return pose.stamp < stamp; }

Eigen::Isometry3d interpolate(const StampedPose& a, const StampedPose& b, double stamp) {
  const double share = (stamp - a.stamp) / (b.stamp - a.stamp);
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::Quaterniond(a.pose.linear())
                   .slerp(share, Eigen::Quaterniond(b.pose.linear()))
                   .toRotationMatrix();
  T.translation() = (1.0 - share) * a.pose.translation() + share * b.pose.translation();
  return T;
}

void addAbsoluteErrors(const std::vector<PosePair>& poses, const Eigen::Isometry3d& T_world_map,
                       RootMeanSquare& errors) {
  for (const PosePair& pose : poses) {
    errors.add(
        (T_world_map * pose.T_map_camera.translation() - pose.T_world_camera.translation()).norm());
  }
}

/// Index of the pose closest to `stamp` at or after `first`; nothing when none is near.
std::optional<std::size_t> closestPose(const std::vector<PosePair>& poses, std::size_t first,
                                       double stamp) {
  std::optional<std::size_t> closest;
  double distance = kIntervalTolerance;
  for (std::size_t i = first; i < poses.size() && poses[i].stamp <= stamp + distance; ++i) {
    if (std::abs(poses[i].stamp - stamp) > distance) continue;
    distance = std::abs(poses[i].stamp - stamp);
    closest = i;
  }
  return closest;
}

void addRelativeErrors(const std::vector<PosePair>& poses, RootMeanSquare& translation,
                       RootMeanSquare& rotation) {
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const auto j = closestPose(poses, i + 1, poses[i].stamp + kRelativeInterval);
    if (!j) continue;
    const Eigen::Isometry3d T_truth = poses[i].T_world_camera.inverse() * poses[*j].T_world_camera;
    const Eigen::Isometry3d T_estimate = poses[i].T_map_camera.inverse() * poses[*j].T_map_camera;
    const Eigen::Isometry3d T_error = T_truth.inverse() * T_estimate;
    translation.add(T_error.translation().norm());
    rotation.add(rotationAngle(T_error));
  }
}

/// T_world_map from the poses of the first second: mean rotation (largest eigenvector of the
/// quaternions' scatter), then mean position. Works for a robot that still stands.
Eigen::Isometry3d alignStart(const std::vector<PosePair>& poses) {
  Eigen::Matrix4d scatter = Eigen::Matrix4d::Zero();
  Eigen::Vector3d truth = Eigen::Vector3d::Zero();
  Eigen::Vector3d estimate = Eigen::Vector3d::Zero();
  double count = 0.0;
  for (const PosePair& pose : poses) {
    if (pose.stamp > poses.front().stamp + kStartInterval) break;
    const Eigen::Vector4d q =
        Eigen::Quaterniond(pose.T_world_camera.linear() * pose.T_map_camera.linear().transpose())
            .coeffs();
    scatter += q * q.transpose();
    truth += pose.T_world_camera.translation();
    estimate += pose.T_map_camera.translation();
    count += 1.0;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> eigen(scatter);
  const Eigen::Vector4d q = eigen.eigenvectors().col(3);
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::Quaterniond(q).normalized().toRotationMatrix();
  T.translation() = truth / count - T.linear() * (estimate / count);
  return T;
}

double endError(const std::vector<PosePair>& poses) {
  const PosePair& last = poses.back();
  return (alignStart(poses) * last.T_map_camera.translation() - last.T_world_camera.translation())
      .norm();
}

double pathLength(const std::vector<PosePair>& poses) {
  double length = 0.0;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    length +=
        (poses[i].T_world_camera.translation() - poses[i - 1].T_world_camera.translation()).norm();
  }
  return length;
}

}  // namespace

std::optional<Eigen::Isometry3d> poseAt(const Trajectory& trajectory, double stamp,
                                        double longest_gap) {
  const auto after = std::lower_bound(trajectory.begin(), trajectory.end(), stamp, earlier);
  if (after != trajectory.end() && after->stamp - stamp <= kSameStamp) return after->pose;
  if (after == trajectory.begin()) return std::nullopt;
  const auto before = after - 1;
  if (stamp - before->stamp <= kSameStamp) return before->pose;
  if (after == trajectory.end() || after->stamp - before->stamp > longest_gap) return std::nullopt;
  return interpolate(*before, *after, stamp);
}

std::vector<PosePair> matchPoses(const TrajectoryPair& trajectories) {
  std::vector<PosePair> poses;
  for (const StampedPose& estimate : trajectories.estimate) {
    const auto truth = poseAt(trajectories.truth, estimate.stamp);
    if (truth) poses.push_back({estimate.stamp, *truth, estimate.pose});
  }
  return poses;
}

Eigen::Isometry3d alignPoses(const std::vector<PosePair>& poses) {
  if (poses.empty()) return Eigen::Isometry3d::Identity();
  Eigen::Matrix3Xd map(3, poses.size());
  Eigen::Matrix3Xd world(3, poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    map.col(column) = poses[i].T_map_camera.translation();
    world.col(column) = poses[i].T_world_camera.translation();
  }
  return Eigen::Isometry3d(Eigen::umeyama(map, world, false));
}

TrajectoryErrors evaluateTrajectories(const std::vector<TrajectoryPair>& trajectories) {
  std::vector<PosePair> all;
  RootMeanSquare absolute, translation, rotation;
  double end_error = 0.0;
  double path = 0.0;
  for (const TrajectoryPair& pair : trajectories) {
    const std::vector<PosePair> poses = matchPoses(pair);
    if (poses.empty()) continue;
    addRelativeErrors(poses, translation, rotation);
    end_error += endError(poses);
    path += pathLength(poses);
    all.insert(all.end(), poses.begin(), poses.end());
  }
  addAbsoluteErrors(all, alignPoses(all), absolute);
  TrajectoryErrors errors;
  errors.pairs = all.size();
  errors.ate_rmse = absolute.value();
  errors.rpe_trans_rmse = translation.value();
  errors.rpe_rot_rmse = rotation.value();
  errors.end_drift = path > 0.0 ? end_error / path : std::numeric_limits<double>::quiet_NaN();
  return errors;
}

double separatelyAlignedError(const std::vector<TrajectoryPair>& trajectories) {
  RootMeanSquare absolute;
  for (const TrajectoryPair& pair : trajectories) {
    const std::vector<PosePair> poses = matchPoses(pair);
    addAbsoluteErrors(poses, alignPoses(poses), absolute);
  }
  return absolute.value();
}

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/planecloud_msgs/pose_conversions.h"

#include <cmath>
#include <string>

namespace planecloud {
namespace {

constexpr double kMaxNormError = 0.01;  // what drivers that publish float32 or text stay below

template <typename Vector>
void writeVector(const Eigen::Vector3d& v, Vector& message) {
  message.x = v.x();
  message.y = v.y();
  message.z = v.z();
}

geometry_msgs::Quaternion writeRotation(const Eigen::Matrix3d& R) {
  const Eigen::Quaterniond q = Eigen::Quaterniond(R).normalized();
  geometry_msgs::Quaternion message;
  message.x = q.x();
  message.y = q.y();
  message.z = q.z();
  message.w = q.w();
  return message;
}

template <typename Vector>
Eigen::Isometry3d read(const Vector& t, const geometry_msgs::Quaternion& r) {
  const Eigen::Vector3d translation(t.x, t.y, t.z);
  const Eigen::Quaterniond rotation(r.w, r.x, r.y, r.z);
  if (!translation.allFinite() || !rotation.coeffs().allFinite()) {
    refuseMessage("pose has a number that is not finite");
  }
  if (!(std::abs(rotation.norm() - 1.0) <= kMaxNormError)) {
    refuseMessage("pose has a quaternion of norm " + std::to_string(rotation.norm()) +
                  ": must be 1");
  }
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = rotation.normalized().toRotationMatrix();
  T.translation() = translation;
  return T;
}

}  // namespace

geometry_msgs::Pose toPoseMessage(const Eigen::Isometry3d& T_frame_body) {
  geometry_msgs::Pose message;
  writeVector(T_frame_body.translation(), message.position);
  message.orientation = writeRotation(T_frame_body.linear());
  return message;
}

geometry_msgs::Transform toTransformMessage(const Eigen::Isometry3d& T_target_source) {
  geometry_msgs::Transform message;
  writeVector(T_target_source.translation(), message.translation);
  message.rotation = writeRotation(T_target_source.linear());
  return message;
}

Eigen::Isometry3d fromMessage(const geometry_msgs::Pose& pose) {
  return read(pose.position, pose.orientation);
}

Eigen::Isometry3d fromMessage(const geometry_msgs::Transform& transform) {
  return read(transform.translation, transform.rotation);
}

}  // namespace planecloud

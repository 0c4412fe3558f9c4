// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/frontend_node/wheel_information.h"

namespace planecloud {
namespace {

constexpr double kLeast = 0.02;  // standard deviation, even of no motion [m] and [rad]
constexpr double kSlip = 0.05;   // share of the motion

double information(double motion) {
  const double deviation = kLeast + kSlip * motion;
  return 1.0 / (deviation * deviation);
}

}  // namespace

Matrix6d wheelInformation(const Eigen::Isometry3d& T) {
  Vector6d diagonal;
  diagonal.head<3>().setConstant(information(T.translation().norm()));
  diagonal.tail<3>().setConstant(information(rotationAngle(T)));
  return diagonal.asDiagonal();
}

}  // namespace planecloud

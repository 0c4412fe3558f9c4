// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/frontend_node/wheel_path.h"

namespace planecloud {
namespace {

constexpr double kLeast = 0.02;  // standard deviation, even of no motion [m] and [rad]
constexpr double kSlip = 0.05;   // share of the motion

double informationAfter(double motion) {
  const double deviation = kLeast + kSlip * motion;
  return 1.0 / (deviation * deviation);
}

}  // namespace

void WheelPath::add(const Eigen::Isometry3d& T_previous_current) {
  length_ += T_previous_current.translation().norm();
  turned_ += rotationAngle(T_previous_current);
}

Matrix6d WheelPath::information() const {
  Vector6d diagonal;
  diagonal.head<3>().setConstant(informationAfter(length_));
  diagonal.tail<3>().setConstant(informationAfter(turned_));
  return diagonal.asDiagonal();
}

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/frontend_node/motion_model.h"

#include <algorithm>

namespace planecloud {
namespace {

/// A motion goes on as it was for no longer than this [s].
constexpr double kLongestExtrapolation = 3.0;

}  // namespace

void MotionModel::observe(const Eigen::Isometry3d& T_previous_current, double seconds) {
  velocity_ = logSe3(T_previous_current) / seconds;
  is_known_ = true;
}

std::optional<Eigen::Isometry3d> MotionModel::after(double seconds) const {
  if (!is_known_) return std::nullopt;
  return expSe3(velocity_ * seconds);
}

std::vector<Eigen::Isometry3d> MotionModel::possibleMotions(double seconds) const {
  std::vector<Eigen::Isometry3d> motions;
  const double moved = std::min(seconds, kLongestExtrapolation);
  for (const double share : {0.6, 1.0}) {
    for (const double turn : {0.0, -0.15, 0.15, -0.3, 0.3}) {
      motions.push_back(expSe3(velocity_ * (share * moved)) *
                        Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitY()));
    }
  }
  for (const double forwards : {0.4, 0.8, 1.2}) {
    motions.emplace_back(Eigen::Translation3d(0.0, 0.0, forwards));
  }
  return motions;
}

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

namespace planecloud {

/// The drives that the built-in world offers.
enum class DriveKind {
  kLoop,     ///< clockwise around the block, for ever; starts in the hallway
  kFromLab,  ///< out of the laboratory into the hallway, then around the block
  kFarLoop,  ///< as kLoop, but starts in the southern hallway
  kHallway,  ///< once along the hallway of 15 m, west to east; then stands
};

/// What a robot does at a moment: pose and speed of its base on the floor.
struct BaseState {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< [m]
  double heading = 0.0;    ///< [rad], 0 = along x, counter-clockwise; not wrapped
  double speed = 0.0;      ///< forwards [m/s]
  double turn_rate = 0.0;  ///< [rad/s]
};

/// A TurtleBot that follows a line of waypoints: a unicycle with pure pursuit whose speeds and
/// accelerations are bounded, and whose seed makes it wander around the line. Computed in steps of
/// 1 / kStepsPerSecond.
class RobotPath {
 public:
  static constexpr int kStepsPerSecond = 300;
  static constexpr double kMaxSpeed = 0.5;             ///< [m/s]
  static constexpr double kMaxTurnRate = 1.047;        ///< [rad/s], 60 degrees/s
  static constexpr double kMaxAcceleration = 0.35;     ///< [m/s^2]
  static constexpr double kMaxTurnAcceleration = 2.5;  ///< [rad/s^2]

  /// `duration` [s], (0, 3600]; throws std::invalid_argument when out of range.
  RobotPath(DriveKind kind, std::uint64_t seed, double duration);

  /// One state per step, the first at time 0, standing.
  [[nodiscard]] const std::vector<BaseState>& states() const { return states_; }

 private:
  std::vector<BaseState> states_;
};

/// What the wheels report of a path: increments with a scale error of 1-2 % in distance and in
/// angle and noise, by seed; the first pose is the origin. One pose per state.
[[nodiscard]] std::vector<BaseState> wheelOdometry(const RobotPath& path, std::uint64_t seed);

/// A pose on the floor as a transform, z up.
[[nodiscard]] Eigen::Isometry3d toTransform(const BaseState& state);

}  // namespace planecloud

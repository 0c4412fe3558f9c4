// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "planecloud_slam/rosbags/hallway_world.h"
#include "planecloud_slam/rosbags/robot_path.h"

namespace planecloud {
namespace {

constexpr double kStep = 1.0 / RobotPath::kStepsPerSecond;
constexpr DriveKind kAllDrives[] = {DriveKind::kLoop, DriveKind::kFromLab, DriveKind::kFarLoop,
                                    DriveKind::kHallway};

double travelled(const RobotPath& path) {
  double length = 0.0;
  for (const BaseState& state : path.states()) length += kStep * state.speed;
  return length;
}

TEST(RobotPath, SpeedsAndAccelerationsAreThoseOfATurtleBot) {
  for (const DriveKind kind : kAllDrives) {
    const RobotPath path(kind, 5, 100.0);
    double fastest_turn = 0.0;
    for (std::size_t i = 1; i < path.states().size(); ++i) {
      const BaseState& a = path.states()[i - 1];
      const BaseState& b = path.states()[i];
      ASSERT_LE(b.speed, RobotPath::kMaxSpeed);
      ASSERT_GE(b.speed, 0.0);
      ASSERT_LE(std::abs(b.turn_rate), RobotPath::kMaxTurnRate);
      ASSERT_LE(std::abs(b.speed - a.speed), 1.001 * kStep * RobotPath::kMaxAcceleration);
      ASSERT_LE(std::abs(b.turn_rate - a.turn_rate),
                1.001 * kStep * RobotPath::kMaxTurnAcceleration);
      // Positions and headings are the integrals of the speeds: 1e-9 m of rounding.
      ASSERT_NEAR((b.position - a.position).norm(), kStep * b.speed, 1e-9);
      ASSERT_NEAR(b.heading - a.heading, kStep * b.turn_rate, 1e-9);
      fastest_turn = std::max(fastest_turn, std::abs(b.turn_rate));
    }
    if (kind != DriveKind::kHallway) EXPECT_GT(fastest_turn, 30.0 * M_PI / 180.0);
  }
}

TEST(RobotPath, HitsNothingWhateverTheSeed) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const HallwayWorld world(seed);
    for (const DriveKind kind : kAllDrives) {
      const RobotPath path(kind, seed, 95.0);
      for (std::size_t i = 0; i < path.states().size(); i += 60) {
        const Eigen::Vector2d& place = path.states()[i].position;
        // The robot's radius is 0.18 m.
        ASSERT_GT(world.clearance(place.x(), place.y(), 0.7), 0.25)
            << "seed " << seed << " at " << place.transpose();
      }
    }
  }
}

TEST(RobotPath, TheLoopTakesAMinuteAndComesBackInTheSameDirection) {
  const RobotPath path(DriveKind::kLoop, 1, 84.0);
  const BaseState& start = path.states().front();
  std::size_t back = 40 * RobotPath::kStepsPerSecond;
  while ((path.states()[back].position - start.position).norm() > 0.2) {
    ASSERT_LT(++back, path.states().size());
  }
  EXPECT_GT(static_cast<double>(back) * kStep, 60.0);
  // 5 s of the first round are seen again.
  EXPECT_LT(static_cast<double>(back) * kStep, 79.0);
  EXPECT_NEAR(std::remainder(path.states()[back].heading - start.heading, 2.0 * M_PI), 0.0, 0.2);
}

TEST(RobotPath, TheHallwayDriveStopsAtTheEnd) {
  const RobotPath path(DriveKind::kHallway, 1, 60.0);
  EXPECT_EQ(path.states().back().speed, 0.0);
  EXPECT_NEAR(path.states().back().position.x(), 14.2, 0.15);
}

TEST(RobotPath, RefusesADurationOutOfRange) {
  EXPECT_THROW(RobotPath(DriveKind::kLoop, 1, 0.0), std::invalid_argument);
  EXPECT_THROW(RobotPath(DriveKind::kLoop, 1, 4000.0), std::invalid_argument);
}

TEST(WheelOdometry, DriftsByOneToTwoPercentOfTheDistance) {
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    const RobotPath path(DriveKind::kHallway, seed, 20.0);
    const std::vector<BaseState> odometry = wheelOdometry(path, seed);
    ASSERT_EQ(odometry.size(), path.states().size());
    const double truth = (path.states().back().position - path.states().front().position).norm();
    const double reported = odometry.back().position.norm();
    // The scale error, and a few millimetres of noise.
    EXPECT_NEAR(std::abs(reported / truth - 1.0), 0.015, 0.0075) << travelled(path);
    EXPECT_EQ(odometry.front().position, Eigen::Vector2d::Zero());
  }
}

}  // namespace
}  // namespace planecloud

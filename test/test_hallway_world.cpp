// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "planecloud_slam/rosbags/hallway_recording.h"
#include "planecloud_slam/rosbags/hallway_renderer.h"
#include "planecloud_slam/rosbags/hallway_world.h"

namespace planecloud {
namespace {

/// A camera in the middle of a hallway that looks straight at a wall.
Eigen::Isometry3d facing(double x, double y, double heading) {
  BaseState state;
  state.position = {x, y};
  state.heading = heading;
  Eigen::Isometry3d T_base_camera = Eigen::Isometry3d::Identity();
  T_base_camera.translation().z() = 1.3;
  T_base_camera.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return toTransform(state) * T_base_camera;
}

/// Deviation of the grey levels in a square of pixels, lighting and all.
double deviationOf(const Image<Eigen::Array3f>& color, int x0, int y0, int side) {
  double sum = 0.0;
  double squares = 0.0;
  for (int y = y0; y < y0 + side; ++y) {
    for (int x = x0; x < x0 + side; ++x) {
      const double grey = 0.299 * double{color(x, y).x()} + 0.587 * double{color(x, y).y()} +
                          0.114 * double{color(x, y).z()};
      sum += grey;
      squares += grey * grey;
    }
  }
  const double count = static_cast<double>(side) * side;
  return std::sqrt(std::max(0.0, squares / count - sum * sum / (count * count)));
}

TEST(HallwayWorld, WallsAreOfLowContrastOnMostOfTheirArea) {
  CameraIntrinsics camera;
  camera.width = 640;
  camera.height = 640;
  camera.fx = camera.fy = 320.0;
  camera.cx = camera.cy = 319.5;
  const auto world = std::make_shared<HallwayWorld>(1);
  HallwayRenderer renderer(world, camera);
  int low = 0;
  int all = 0;
  const auto look = [&](double x, double y, double heading) {
    const RenderedView view = renderer.render(facing(x, y, heading));
    // Squares of 0.24 m on what stands and hangs at walls 1.2 m away, doors and posters included.
    for (int row = 0; row < 8; ++row) {
      for (int column = 0; column < 8; ++column) {
        low += deviationOf(view.color, 64 + 64 * column, 64 + 64 * row, 64) <= 8.0 ? 1 : 0;
        ++all;
      }
    }
  };
  for (double x = 1.0; x < 14.5; x += 2.0) {
    look(x, 1.2, 0.5 * M_PI);
    look(x, 1.2, -0.5 * M_PI);
    if (x < 11.5) look(x, -4.3, 0.5 * M_PI);
    if (x < 11.5) look(x, -4.3, -0.5 * M_PI);
  }
  RecordProperty("low_contrast_percent", 100 * low / all);
  EXPECT_GE(low, 0.6 * all) << low << " of " << all;
}

TEST(HallwayWorld, TheHallwayIs15By2Point4Metres) {
  const HallwayWorld world(1);
  // Where the walls are bare, skirting boards (12 mm) are what is nearest.
  double widest = 0.0;
  for (double x = 0.5; x < 14.6; x += 0.05) {
    widest = std::max(widest, world.clearance(x, 1.2, 2.5));
  }
  EXPECT_NEAR(widest, 1.2, 0.013);
  EXPECT_EQ(world.clearance(15.05, 1.2, 2.0), 0.0);
  EXPECT_EQ(world.clearance(-0.05, 1.2, 2.0), 0.0);
}

TEST(HallwayWorld, TheSeedChoosesFurnitureButNotWalls) {
  const HallwayWorld a(1);
  const HallwayWorld b(1);
  const HallwayWorld c(2);
  EXPECT_EQ(a.solids().size(), b.solids().size());
  double difference = 0.0;
  const std::size_t common = std::min(a.solids().size(), c.solids().size());
  for (std::size_t i = 0; i < common; ++i) {
    difference += (a.solids()[i].centre - c.solids()[i].centre).norm();
    EXPECT_EQ(a.solids()[std::min(i, b.solids().size() - 1)].centre, b.solids()[i].centre);
  }
  EXPECT_GT(difference, 1.0);
  EXPECT_EQ(a.solids()[0].centre, c.solids()[0].centre);  // the floor
}

}  // namespace
}  // namespace planecloud

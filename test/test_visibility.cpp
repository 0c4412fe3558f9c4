// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "planecloud_slam/icap/visibility.h"
#include "synthetic_planes.h"

namespace planecloud {
namespace {

constexpr double kNoise = 1.6e-3;  // inverse depth of one pixel, Kinect class [1/m]

SyntheticPlanes wallAt(double x) {
  return SyntheticPlanes({{{x, 0.0, 0.0}, {0.0, 20.0, 0.0}, {0.0, 0.0, 20.0}}});
}

PlaneSet viewOf(const SyntheticPlanes& world, unsigned seed) {
  return PlaneSet(world.view(lookAlongX({0, 0, 0}, 0.0, 0.0), kNoise, seed));
}

TEST(Visibility, AgreesWhenBothSawTheSame) {
  const Eigen::Isometry3d identity = Eigen::Isometry3d::Identity();
  const VisibilityReport report =
      checkVisibility(viewOf(wallAt(2.0), 1), viewOf(wallAt(2.0), 2), identity);
  EXPECT_GT(report.total, 640 * 480 / 10) << "the pieces are a sample of the view";
  EXPECT_EQ(report.viewShare(), 1.0);
  EXPECT_GT(report.overlap(), 0.99);
  EXPECT_EQ(report.seenThroughShare(), 0.0);
}

TEST(Visibility, CountsAWallInFreeSpaceAsSeenThrough) {
  // The target saw the wall at 3 m: there was nothing at 2 m.
  const VisibilityReport report = checkVisibility(viewOf(wallAt(3.0), 1), viewOf(wallAt(2.0), 2),
                                                  Eigen::Isometry3d::Identity());
  EXPECT_EQ(report.seenThroughShare(), 1.0);
  EXPECT_EQ(report.overlap(), 0.0);
}

TEST(Visibility, CountsAWallBehindAnotherAsOccludedNotAsContradiction) {
  const VisibilityReport report = checkVisibility(viewOf(wallAt(2.0), 1), viewOf(wallAt(3.0), 2),
                                                  Eigen::Isometry3d::Identity());
  EXPECT_EQ(report.occluded, report.in_view);
  EXPECT_EQ(report.seenThroughShare(), 0.0);
  EXPECT_EQ(report.overlap(), 0.0);
}

TEST(Visibility, TellsAnotherOrientationFromAgreement) {
  // A wall turned by 45 degrees that crosses the other one on the optical axis.
  const Eigen::Vector3d slanted(20.0, 20.0, 0.0);
  const SyntheticPlanes turned({{{2.0, 0.0, 0.0}, slanted, {0.0, 0.0, 20.0}}});
  const VisibilityReport report =
      checkVisibility(viewOf(wallAt(2.0), 1), viewOf(turned, 2), Eigen::Isometry3d::Identity());
  EXPECT_EQ(report.agreeing, 0.0);
  EXPECT_GT(report.differing, 0.0);
  EXPECT_GT(report.occluded, 0.0);
  EXPECT_GT(report.seen_through, 0.0);
}

TEST(Visibility, LeavesOutWhatTheTargetCannotSee) {
  const PlaneSet view = viewOf(wallAt(2.0), 1);
  Eigen::Isometry3d turned_away = Eigen::Isometry3d::Identity();
  turned_away.linear() =
      Eigen::AngleAxisd(1.5707963267948966, Eigen::Vector3d::UnitY()).toRotationMatrix();
  EXPECT_EQ(checkVisibility(view, view, turned_away).in_view, 0.0);
  const VisibilityReport nothing = checkVisibility(PlaneSet(), view, Eigen::Isometry3d::Identity());
  EXPECT_EQ(nothing.overlap(), 0.0);
  EXPECT_EQ(nothing.seenThroughShare(), 0.0);
  EXPECT_EQ(checkVisibility(view, PlaneSet(), Eigen::Isometry3d::Identity()).viewShare(), 0.0);
}

TEST(Visibility, HasNoOpinionWhereTheTargetHasNoTile) {
  PlaneCloud half = wallAt(2.0).view(lookAlongX({0, 0, 0}, 0.0, 0.0), kNoise, 1);
  const auto on_the_right = [](const PlanarTile& tile) { return tile.rect.x >= 320; };
  half.tiles.erase(std::remove_if(half.tiles.begin(), half.tiles.end(), on_the_right),
                   half.tiles.end());
  const VisibilityReport report =
      checkVisibility(PlaneSet(half), viewOf(wallAt(2.0), 2), Eigen::Isometry3d::Identity());
  EXPECT_NEAR(report.unknown / report.total, 0.5, 0.05);
  EXPECT_GT(report.overlap(), 0.99);
}

}  // namespace
}  // namespace planecloud

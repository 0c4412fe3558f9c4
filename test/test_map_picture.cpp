// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "planecloud_slam/rosbags/map_picture.h"
#include "planecloud_slam/rosbags/surface_samples.h"
#include "room_map.h"

namespace planecloud {
namespace {

/// A robot that looks at the four walls of a room of 4 m x 4 m, turned by `tilt` in the map.
MapSnapshot room(double tilt) {
  MapSnapshot map;
  for (std::uint32_t i = 0; i < 12; ++i) {
    const double heading = tilt + M_PI / 2.0 * (i % 4);
    addKeyframe(map, {"robot1", 1, i}, i, levelCamera(0.02 * i, 0.0, heading), wallAndFloor(2.0));
  }
  return map;
}

MapPicture pictureOf(const MapSnapshot& map) {
  MapPicture picture;
  picture.title = "A room";
  picture.robots.push_back({"robot1", {}, {}, {}});
  for (const MapSnapshot::Node& node : map.nodes) {
    picture.robots[0].optimised.push_back({node.keyframe->stamp, node.T_map_camera});
  }
  return picture;
}

double darkShare(const cv::Mat& picture) {
  int dark = 0;
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.cols; ++x) {
      const cv::Vec3b& pixel = picture.at<cv::Vec3b>(y, x);
      dark += pixel[0] + pixel[1] + pixel[2] < 3 * 128 ? 1 : 0;
    }
  }
  return static_cast<double>(dark) / static_cast<double>(picture.total());
}

TEST(MapPicture, ShowsWallsOnPaperThatStaysMostlyLight) {
  const MapSnapshot map = room(0.0);
  const cv::Mat picture = drawMap(map, pictureOf(map));
  ASSERT_EQ(picture.type(), CV_8UC3);
  EXPECT_GT(picture.cols, 600);
  EXPECT_GT(picture.rows, 300);
  EXPECT_GT(darkShare(picture), 0.002);
  EXPECT_LT(darkShare(picture), 0.3);
}

TEST(MapPicture, IsDrawnWithoutAMapAndWithoutRobots) {
  EXPECT_FALSE(drawMap({}, {}).empty());
  const MapSnapshot map = room(0.0);
  EXPECT_FALSE(drawMap(map, {}).empty());
}

TEST(MapPicture, ClosuresAreDrawnAndFalseOnesInRed) {
  const MapSnapshot map = room(0.0);
  MapPicture picture = pictureOf(map);
  const cv::Mat without = drawMap(map, picture);
  JudgedClosure closure;
  closure.edge.from = map.nodes[0].keyframe->id;
  closure.edge.to = map.nodes[11].keyframe->id;
  closure.verdict = ClosureTruth::kFalse;
  picture.closures.push_back(closure);
  const cv::Mat with = drawMap(map, picture);
  ASSERT_EQ(with.size(), without.size());
  int red = 0;
  for (int y = 0; y < with.rows; ++y) {
    for (int x = 0; x < with.cols; ++x) {
      const cv::Vec3b& pixel = with.at<cv::Vec3b>(y, x);
      red += pixel[2] > 200 && pixel[1] < 60 && pixel[0] < 60 ? 1 : 0;
    }
  }
  EXPECT_GT(red, 20);
}

SurfaceSampling samplingOfRobot1() {
  SurfaceSampling sampling;
  sampling.robots = {"robot1"};
  return sampling;
}

TEST(SurfaceSamples, TurnWallsParallelToTheAxes) {
  for (const double tilt : {-0.6, -0.1, 0.0, 0.3, 0.7}) {
    const auto samples = sampleSurfaces(room(tilt), samplingOfRobot1());
    EXPECT_NEAR(alignWallsWithAxes(samples), -tilt, 1e-3);
  }
}

TEST(SurfaceSamples, FindTheFloor) {
  const auto samples = sampleSurfaces(room(0.2), samplingOfRobot1());
  EXPECT_NEAR(findFloorHeight(samples), 0.0F, 0.05F);  // a bin of the histogram
  EXPECT_EQ(findFloorHeight({}), 0.0F);
}

TEST(SurfaceSamples, CoverTheSurfaceTheyStandFor) {
  MapSnapshot map;
  PlaneCloud cloud = wallAndFloor(2.0);
  cloud.tiles.resize(1);
  addKeyframe(map, {"robot1", 1, 0}, 0.0, levelCamera(0.0, 0.0, 0.0), cloud);
  double area = 0.0;
  for (const SurfaceSample& sample : sampleSurfaces(map, samplingOfRobot1())) {
    area += static_cast<double>(sample.area);
    EXPECT_NEAR(sample.position.x(), 2.0F, 1e-4F);
    EXPECT_NEAR(sample.normal.x(), -1.0F, 1e-4F);
  }
  const double side = 20.0 * 2.0 / 140.0;  // 20 px of 2 m distant wall
  EXPECT_NEAR(area, side * side, 1e-4);
}

}  // namespace
}  // namespace planecloud

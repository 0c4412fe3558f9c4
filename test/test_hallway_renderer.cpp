// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <opencv2/core/utility.hpp>

#include "planecloud_slam/rosbags/hallway_recording.h"
#include "planecloud_slam/rosbags/hallway_renderer.h"

namespace planecloud {
namespace {

CameraIntrinsics smallCamera() {
  CameraIntrinsics camera;
  camera.width = 150;  // no multiple of a tile
  camera.height = 110;
  camera.fx = 130.0;
  camera.fy = 140.0;
  camera.cx = 70.3;
  camera.cy = 52.1;
  return camera;
}

Eigen::Isometry3d somePose() {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() << 3.4, 1.1, 0.7;
  Eigen::Matrix3d axes;
  axes << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  pose.linear() = Eigen::AngleAxisd(0.3, Eigen::Vector3d(0.1, 0.2, 1.0).normalized()) * axes;
  return pose;
}

/// Where a ray first enters a box or cylinder, in double precision and by another way: by the
/// solid's signed planes for boxes, by the quadratic for mantles.
double distanceAlong(const Solid& solid, const Eigen::Vector3d& origin,
                     const Eigen::Vector3d& direction) {
  const Eigen::AngleAxisd turn(-solid.yaw, Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d o = turn * (origin - solid.centre);
  const Eigen::Vector3d d = turn * direction;
  double nearest = std::numeric_limits<double>::infinity();
  const auto consider = [&](double t, bool inside) {
    if (t > 0.02 && inside && t < nearest) nearest = t;
  };
  const auto within = [&](const Eigen::Vector3d& p, int axis) {
    if (solid.shape == Solid::Shape::kCylinder) return p.head<2>().norm() < solid.half.x();
    const Eigen::Vector3d excess = p.cwiseAbs() - solid.half;
    return excess[(axis + 1) % 3] < 0.0 && excess[(axis + 2) % 3] < 0.0;
  };
  for (int axis = solid.shape == Solid::Shape::kBox ? 0 : 2; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      const double t = (side * solid.half[axis] - o[axis]) / d[axis];
      consider(t, within(o + t * d, axis));
    }
  }
  if (solid.shape == Solid::Shape::kCylinder) {
    const double a = d.head<2>().squaredNorm();
    const double b = o.head<2>().dot(d.head<2>());
    const double root = b * b - a * (o.head<2>().squaredNorm() - std::pow(solid.half.x(), 2));
    const double t = root > 0.0 ? (-b - std::sqrt(root)) / a : -1.0;
    consider(t, std::abs(o.z() + t * d.z()) < solid.half.z());
  }
  return nearest;
}

TEST(HallwayRenderer, DepthIsThatOfTheNearestSolidAlongEachRay) {
  const auto world = std::make_shared<HallwayWorld>(4);
  const CameraIntrinsics camera = smallCamera();
  const Eigen::Isometry3d pose = somePose();
  const RenderedView view = HallwayRenderer(world, camera).render(pose);
  int compared = 0;
  for (int y = 0; y < camera.height; y += 7) {
    for (int x = 0; x < camera.width; x += 5) {
      const Eigen::Vector3d ray((x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy, 1.0);
      double nearest = std::numeric_limits<double>::infinity();
      for (const Solid& solid : world->solids()) {
        nearest = std::min(nearest, distanceAlong(solid, pose.translation(), pose.linear() * ray));
      }
      ASSERT_TRUE(std::isfinite(nearest)) << "the world is closed";
      // 0.1 mm: single precision over 20 m, and rays that graze an edge.
      compared += std::abs(double{view.depth(x, y)} - nearest) < 1e-4 ? 1 : 0;
    }
  }
  const int rays = 16 * 30;
  EXPECT_GE(compared, rays - 2) << "an edge may be hit or missed by rounding, rarely";
}

TEST(HallwayRenderer, ResultDoesNotDependOnThreads) {
  const auto world = std::make_shared<HallwayWorld>(4);
  HallwayRenderer renderer(world, smallCamera());
  const int threads = cv::getNumThreads();
  cv::setNumThreads(1);
  const RenderedView one = renderer.render(somePose());
  cv::setNumThreads(4);
  const RenderedView four = renderer.render(somePose());
  cv::setNumThreads(threads);
  for (std::size_t i = 0; i < one.depth.size(); ++i) {
    ASSERT_EQ(one.depth.begin()[i], four.depth.begin()[i]);
    ASSERT_TRUE((one.color.begin()[i] == four.color.begin()[i]).all());
  }
}

TEST(HallwayRenderer, ASurfaceLooksTheSameFromTwoPlaces) {
  // The floor, seen by a camera that looks straight down from two places: no highlights.
  CameraIntrinsics camera = smallCamera();
  camera.cx = 74.0;
  camera.cy = 54.0;
  camera.fx = camera.fy = 100.0;
  HallwayRenderer renderer(std::make_shared<HallwayWorld>(4), camera);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  pose.translation() << 5.0, 1.2, 0.5;
  const RenderedView first = renderer.render(pose);
  pose.translation().x() += 0.1;  // 20 pixels
  const RenderedView second = renderer.render(pose);
  for (int y = 20; y < 90; ++y) {
    for (int x = 30; x < 120; ++x) {
      ASSERT_NEAR(first.color(x + 20, y).x(), second.color(x, y).x(), 0.5F);
    }
  }
}

TEST(HallwayRenderer, RefusesLensDistortion) {
  CameraIntrinsics camera = smallCamera();
  camera.distortion[0] = 0.1;
  EXPECT_THROW(HallwayRenderer(std::make_shared<HallwayWorld>(1), camera), std::invalid_argument);
}

}  // namespace
}  // namespace planecloud

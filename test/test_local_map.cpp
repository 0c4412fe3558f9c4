// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "planecloud_slam/frontend_node/local_map.h"
#include "synthetic_scene.h"

namespace planecloud {
namespace {

using synthetic::pose;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

LocalMapOptions everyFrame() {
  LocalMapOptions options;
  options.interval = 1;
  return options;
}

/// Mean error of inverse depth where both are known [1/m].
double meanError(const Image<float>& depth, const Image<float>& truth) {
  double sum = 0.0;
  int n = 0;
  for (int y = 0; y < depth.height(); ++y) {
    for (int x = 0; x < depth.width(); ++x) {
      if (!(depth(x, y) > 0.0F)) continue;
      sum += std::abs(1.0 / depth(x, y) - 1.0 / truth(x, y));
      ++n;
    }
  }
  return sum / n;
}

Image<float> noisyDepth(const Eigen::Isometry3d& T_world_camera, unsigned seed) {
  synthetic::SceneOptions options;
  options.depth_noise = 0.005;
  options.seed = seed;
  return synthetic::render(synthetic::camera(), T_world_camera, options).depth;
}

TEST(LocalMap, FusionReducesTheNoise) {
  const Image<float> truth = synthetic::render(synthetic::camera(), pose(0, 0, 0)).depth;
  LocalMap map(everyFrame(), synthetic::camera());
  map.open(noisyDepth(pose(0, 0, 0), 1).view());
  const double before = meanError(map.depth(), truth);
  for (unsigned i = 1; i <= 15; ++i) {
    const Eigen::Isometry3d T = pose(0.01 * i, 0.004 * i, -0.005 * i, 0, 0.005 * i, 0);
    map.fuse(noisyDepth(T, 1 + i).view(), T);
  }
  // Sixteen independent samples would give a quarter; interpolation and the gate change that.
  EXPECT_LT(meanError(map.depth(), truth), 0.4 * before);
}

TEST(LocalMap, OccludersStayOutside) {
  LocalMap map(everyFrame(), synthetic::camera());
  map.open(Image<float>(320, 240, 2.0F).view());
  for (int i = 0; i < 10; ++i) {
    map.fuse(Image<float>(320, 240, 1.0F).view(), Eigen::Isometry3d::Identity());
  }
  for (const float z : map.depth()) EXPECT_EQ(z, 2.0F);
}

TEST(LocalMap, HolesTakeWhatOtherFramesSee) {
  Image<float> with_hole(320, 240, 2.0F);
  for (int y = 100; y < 140; ++y) {
    for (int x = 100; x < 140; ++x) with_hole(x, y) = kNan;
  }
  LocalMap map(everyFrame(), synthetic::camera());
  map.open(with_hole.view());
  // Each frame fills every fourth row.
  for (int i = 0; i < 4; ++i) map.fuse(Image<float>(320, 240, 2.0F).view(), pose(0.05, 0, 0));
  int left = 0;
  for (const float z : map.depth()) left += z > 0.0F ? 0 : 1;
  EXPECT_LT(left, 100);
}

TEST(LocalMap, KeepsTheFirstDepthWhenFusionIsOff) {
  LocalMapOptions options = everyFrame();
  options.fuse = false;
  LocalMap map(options, synthetic::camera());
  map.open(Image<float>(320, 240, 2.0F).view());
  map.fuse(Image<float>(320, 240, 2.01F).view(), Eigen::Isometry3d::Identity());
  for (const float z : map.depth()) EXPECT_EQ(z, 2.0F);
}

TEST(LocalMap, InvalidDepthsAreNoDepths) {
  LocalMap map(everyFrame(), synthetic::camera());
  for (const float z : {kNan, 0.0F, -1.0F, std::numeric_limits<float>::infinity()}) {
    map.open(Image<float>(320, 240, z).view());
    map.fuse(Image<float>(320, 240, z).view(), pose(0.01, 0, 0));
    EXPECT_TRUE(std::isnan(map.depth()(5, 5))) << z;
  }
}

TEST(LocalMap, RefusesDistortion) {
  CameraIntrinsics distorted = synthetic::camera();
  distorted.distortion[0] = 0.1;
  EXPECT_THROW(LocalMap(LocalMapOptions{}, distorted), std::invalid_argument);
}

}  // namespace
}  // namespace planecloud

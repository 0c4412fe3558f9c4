// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "planecloud_slam/frontend_node/tracking_reference.h"
#include "synthetic_scene.h"

namespace planecloud {
namespace {

using synthetic::pose;

const Eigen::Isometry3d kMotion = pose(0.1, 0.0, 0.05, 0.0, 0.03, 0.0);

RgbdFrame frameAt(const Eigen::Isometry3d& T_world_camera) {
  return synthetic::render(synthetic::camera(), T_world_camera);
}

RgbdPyramid pyramidOf(const RgbdFrame& frame) {
  RgbdPyramid pyramid(synthetic::camera(), DenseTrackerOptions());
  pyramid.assign(frame.grey.view(), frame.depth.view());
  return pyramid;
}

/// A checkered board in front of the left half of the image.
constexpr float kBoard = 0.5F;  // [m]
void putBoardInFront(RgbdFrame& frame) {
  for (int y = 0; y < frame.grey.height(); ++y) {
    for (int x = 0; x < frame.grey.width() / 2; ++x) {
      frame.grey(x, y) = (x / 8 + y / 8) % 2 == 0 ? 30 : 220;
      frame.depth(x, y) = kBoard;
    }
  }
}

std::size_t countOnBoard(const ReferencePoints& points) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < points.count; ++i) count += points.q[i] > 0.9F / kBoard ? 1U : 0U;
  return count;
}

TEST(TrackingReference, LeavesOutWhatHasMovedIn) {
  const RgbdPyramid earlier = pyramidOf(frameAt(pose(0, 0, 0)));
  RgbdFrame frame = frameAt(kMotion);
  putBoardInFront(frame);
  const RgbdPyramid current = pyramidOf(frame);
  const TrackingReference naive(current, DenseTrackerOptions());
  const TrackingReference aware(current, DenseTrackerOptions(), {{&earlier, kMotion}});
  for (std::size_t level = 0; level < aware.levels().size(); ++level) {
    EXPECT_GT(countOnBoard(naive.levels()[level]), naive.levels()[level].count / 3) << level;
    // But where the earlier image did not look.
    EXPECT_LT(countOnBoard(aware.levels()[level]), aware.levels()[level].count / 20) << level;
    EXPECT_GT(aware.levels()[level].count, 100U) << level;
  }
}

TEST(TrackingReference, KeepsWhatStandsStill) {
  const RgbdPyramid earlier = pyramidOf(frameAt(pose(0, 0, 0)));
  const RgbdPyramid current = pyramidOf(frameAt(kMotion));
  const TrackingReference naive(current, DenseTrackerOptions());
  const TrackingReference aware(current, DenseTrackerOptions(), {{&earlier, kMotion}});
  for (std::size_t level = 0; level < aware.levels().size(); ++level) {
    EXPECT_EQ(aware.levels()[level].count, naive.levels()[level].count) << level;
  }
}

}  // namespace
}  // namespace planecloud

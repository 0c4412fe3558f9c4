// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "planecloud_slam/frontend_node/depth_fusion.h"
#include "synthetic_scene.h"

namespace planecloud {
namespace {

using synthetic::pose;

FusionWarp warpBy(const Eigen::Isometry3d& T) {
  return {T.linear().cast<float>(), T.translation().cast<float>(), synthetic::camera(), 0.02F, 30};
}

class DepthFusionTest : public ::testing::Test {
 protected:
  DepthFusionTest() {
    for (int x = 0; x < camera_.width; ++x) {
      tangents_.push_back(static_cast<float>((x - camera_.cx) / camera_.fx));
    }
    // A hole, and a row end that is no multiple of the vector's width.
    for (int x = 100; x < 120; ++x) frame_.depth(x, 60) = std::nanf("");
  }
  [[nodiscard]] FusionRow row(int y) const {
    return {tangents_.data(), static_cast<float>((y - camera_.cy) / camera_.fy), camera_.width - 3};
  }

  CameraIntrinsics camera_ = synthetic::camera();
  RgbdFrame keyframe_ = synthetic::render(camera_, pose(0, 0, 0), {0.0, 0.002, 1.0, 0.0, 1});
  RgbdFrame frame_ =
      synthetic::render(camera_, pose(0.1, 0.02, 0, 0, 0.1, 0), {0.0, 0.002, 1.0, 0.0, 2});
  std::vector<float> tangents_;
};

TEST_F(DepthFusionTest, VectorAndScalarLoopsImproveAlike) {
  const FusionWarp warp = warpBy(pose(0.1, 0.02, 0, 0, 0.1, 0).inverse());
  std::size_t improved = 0;
  for (int y = 0; y < camera_.height; y += 7) {
    std::vector<float> scalar_mean;
    std::vector<std::uint8_t> scalar_n(tangents_.size(), 1);
    for (int x = 0; x < camera_.width; ++x) scalar_mean.push_back(1.0F / keyframe_.depth(x, y));
    std::vector<float> vector_mean = scalar_mean;
    std::vector<std::uint8_t> vector_n = scalar_n;
    const FusionRow at = row(y);
    scalarFusionKernels().improve(warp, at, frame_.depth.view(), scalar_mean.data(),
                                  scalar_n.data());
    vectorFusionKernels().improve(warp, at, frame_.depth.view(), vector_mean.data(),
                                  vector_n.data());
    std::size_t different = 0;
    for (std::size_t i = 0; i < tangents_.size(); ++i) {
      improved += scalar_n[i] > 1 ? 1U : 0U;
      different += std::abs(scalar_mean[i] - vector_mean[i]) > 1e-6F ? 1U : 0U;
    }
    EXPECT_LE(different, 2U) << y;  // pixels on the border of the image or of the gate
  }
  EXPECT_GT(improved, 2000U);
}

TEST_F(DepthFusionTest, VectorAndScalarLoopsProjectAlike) {
  const FusionWarp warp = warpBy(pose(0.1, 0.02, 0, 0, 0.1, 0));
  for (const int y : {0, 60, 120, 239}) {
    std::vector<int> scalar_at(tangents_.size(), -2), vector_at(tangents_.size(), -2);
    std::vector<float> scalar_q(tangents_.size()), vector_q(tangents_.size());
    const FusionRow at = row(y);
    scalarFusionKernels().project(warp, at, frame_.depth.row(y), scalar_at.data(), scalar_q.data());
    vectorFusionKernels().project(warp, at, frame_.depth.row(y), vector_at.data(), vector_q.data());
    std::size_t different = 0;
    for (std::size_t i = 0; i < tangents_.size(); ++i) {
      different += scalar_at[i] != vector_at[i] ? 1U : 0U;
      if (scalar_at[i] >= 0 && vector_at[i] >= 0) {
        EXPECT_NEAR(scalar_q[i], vector_q[i], 1e-5F);
      }
    }
    EXPECT_LE(different, 3U) << y;  // positions half-way between two pixels
  }
}

}  // namespace
}  // namespace planecloud

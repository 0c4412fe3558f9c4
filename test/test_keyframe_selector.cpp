// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "planecloud_slam/frontend_node/keyframe_selector.h"
#include "synthetic_scene.h"

namespace planecloud {
namespace {

using synthetic::pose;

TEST(KeyframeSelector, TranslationAndRotationEachSuffice) {
  KeyframeSelector selector(KeyframeSelectorOptions{});
  const Matrix6d information = 1e6 * Matrix6d::Identity();
  EXPECT_FALSE(selector.isLeavingKeyframe(pose(0.15, 0, 0, 0, 0.1, 0), information, 1.0));
  EXPECT_TRUE(selector.isLeavingKeyframe(pose(0.3, 0, 0), information, 1.0));
  EXPECT_TRUE(selector.isLeavingKeyframe(pose(0, 0, 0, 0, 0.4, 0), information, 1.0));
}

TEST(KeyframeSelector, LosingTheViewEndsTheKeyframe) {
  KeyframeSelectorOptions options;
  options.min_overlap = 0.7;
  KeyframeSelector selector(options);
  const Matrix6d information = 1e6 * Matrix6d::Identity();
  EXPECT_FALSE(selector.isLeavingKeyframe(pose(0.01, 0, 0), information, 0.75));
  EXPECT_TRUE(selector.isLeavingKeyframe(pose(0.01, 0, 0), information, 0.65));
}

TEST(KeyframeSelector, GrowingUncertaintyEndsTheKeyframe) {
  KeyframeSelector selector(KeyframeSelectorOptions{});
  EXPECT_FALSE(selector.isLeavingKeyframe(pose(0.05, 0, 0), 1e6 * Matrix6d::Identity(), 1.0));
  EXPECT_FALSE(selector.isLeavingKeyframe(pose(0.06, 0, 0), 7e5 * Matrix6d::Identity(), 1.0));
  EXPECT_TRUE(selector.isLeavingKeyframe(pose(0.07, 0, 0), 1e4 * Matrix6d::Identity(), 1.0));
  EXPECT_LT(selector.entropyRatio(), 0.85);
  selector.reset();
  EXPECT_FALSE(selector.isLeavingKeyframe(pose(0.01, 0, 0), 1e4 * Matrix6d::Identity(), 1.0));
}

TEST(KeyframeSelector, EntropyIsThatOfAGaussian) {
  // Kerl 2013b eq. (11) with Sigma = I: 3 (1 + ln 2 pi).
  EXPECT_NEAR(poseEntropy(Matrix6d::Identity()), 3.0 * (1.0 + std::log(2.0 * M_PI)), 1e-12);
  EXPECT_NEAR(poseEntropy(4.0 * Matrix6d::Identity()) - poseEntropy(Matrix6d::Identity()),
              -3.0 * std::log(4.0), 1e-12);
  EXPECT_EQ(poseEntropy(Matrix6d::Zero()), std::numeric_limits<double>::infinity());
}

TEST(KeyframeSelector, AnAlignmentWithoutInformationEndsTheKeyframe) {
  KeyframeSelector selector(KeyframeSelectorOptions{});
  EXPECT_FALSE(selector.isLeavingKeyframe(pose(0, 0, 0), 1e6 * Matrix6d::Identity(), 1.0));
  EXPECT_TRUE(selector.isLeavingKeyframe(pose(0, 0, 0), Matrix6d::Zero(), 1.0));
}

TEST(KeyframeSelector, NamesTheOptionOutOfRange) {
  KeyframeSelectorOptions options;
  options.max_translation = 0.0;
  try {
    const KeyframeSelector selector(options);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "keyframe/max_translation = 0: must be in [0.01, 10]");
  }
}

}  // namespace
}  // namespace planecloud

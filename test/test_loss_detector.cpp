// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <limits>

#include "planecloud_slam/frontend_node/loss_detector.h"
#include "synthetic_scene.h"

namespace planecloud {
namespace {

using synthetic::pose;

Alignment goodAlignment() {
  Alignment alignment;
  alignment.status = AlignmentStatus::kConverged;
  alignment.overlap = 0.8;
  alignment.inliers = 0.95;
  alignment.scale = {5.0, 0.03, 0.0};
  return alignment;
}

const TrackedMotion kSmallMotion{1.0, synthetic::pose(0.01, 0, 0), 0.033};

TEST(LossDetector, GoodImagesAndAlignmentsHaveNoFault) {
  const LossDetector detector(LossOptions{});
  EXPECT_EQ(detector.findImageFault(synthetic::render(synthetic::camera(), pose(0, 0, 0))), "");
  EXPECT_EQ(detector.findAlignmentFault(goodAlignment(), kSmallMotion), "");
}

TEST(LossDetector, ImagesWithoutDepthAreUseless) {
  const LossDetector detector(LossOptions{});
  RgbdFrame frame = synthetic::render(synthetic::camera(), pose(0, 0, 0));
  for (const float z : {0.0F, std::numeric_limits<float>::quiet_NaN()}) {
    frame.depth = Image<float>(320, 240, z);
    EXPECT_EQ(detector.findImageFault(frame), "the depth image has no valid pixel");
  }
}

TEST(LossDetector, BlackAndConstantImagesAreUseless) {
  const LossDetector detector(LossOptions{});
  RgbdFrame frame = synthetic::render(synthetic::camera(), pose(0, 0, 0));
  for (const std::uint8_t grey : {0, 128, 255}) {
    frame.grey = Image<std::uint8_t>(320, 240, grey);
    EXPECT_NE(detector.findImageFault(frame).find("blank"), std::string::npos);
  }
}

TEST(LossDetector, NamesWhatIsWrongWithAnAlignment) {
  const LossDetector detector(LossOptions{});
  const auto fault = [&](auto&& spoil) {
    Alignment alignment = goodAlignment();
    spoil(alignment);
    return detector.findAlignmentFault(alignment, kSmallMotion);
  };
  EXPECT_NE(fault([](Alignment& a) { a.status = AlignmentStatus::kTooFewPoints; }), "");
  EXPECT_NE(fault([](Alignment& a) { a.status = AlignmentStatus::kNotConverged; }), "");
  EXPECT_NE(fault([](Alignment& a) { a.status = AlignmentStatus::kDegenerate; }), "");
  EXPECT_NE(fault([](Alignment& a) { a.overlap = 0.05; }).find("in view"), std::string::npos);
  EXPECT_NE(fault([](Alignment& a) { a.inliers = 0.2; }).find("agreeing"), std::string::npos);
  EXPECT_NE(fault([](Alignment& a) { a.scale.sigma_q = 0.5; }), "");
  EXPECT_NE(fault([](Alignment& a) { a.scale.sigma_grey = 60.0; }), "");
}

TEST(LossDetector, AfterALossResidualsMustBeNearTheNormal) {
  LossDetector detector(LossOptions{});
  detector.learn(goodAlignment());
  Alignment alignment = goodAlignment();
  EXPECT_EQ(detector.findDoubt(alignment), "");
  alignment.scale.sigma_grey = 14.0;  // 2.8 times
  EXPECT_NE(detector.findDoubt(alignment).find("grey"), std::string::npos);
  EXPECT_EQ(detector.findDoubt(alignment, true), "");
  alignment.scale.sigma_grey = 17.0;  // 3.4 times
  EXPECT_NE(detector.findDoubt(alignment, true).find("grey"), std::string::npos);
}

TEST(LossDetector, TakesManyDepthsThatDisagreeForAnObstruction) {
  LossDetector detector(LossOptions{});
  Alignment alignment = goodAlignment();
  alignment.inliers = 0.6;
  EXPECT_FALSE(detector.isObstructed(alignment));  // nothing is known to be normal
  detector.learn(goodAlignment());
  EXPECT_TRUE(detector.isObstructed(alignment));
  alignment.overlap = 0.3;  // the keyframe has nearly left the view
  EXPECT_FALSE(detector.isObstructed(alignment));
  alignment.overlap = 0.8;
  alignment.inliers = 0.75;
  EXPECT_FALSE(detector.isObstructed(alignment));
}

TEST(LossDetector, AfterALossAnythingOutOfTheOrdinaryIsAnObstruction) {
  LossDetector detector(LossOptions{});
  detector.learn(goodAlignment());
  EXPECT_TRUE(detector.isOrdinary(goodAlignment()));
  EXPECT_FALSE(detector.isObstructed(goodAlignment(), true));
  Alignment brighter = goodAlignment();
  brighter.scale.sigma_grey *= 2.0;
  Alignment holey = goodAlignment();
  holey.inliers -= 0.15;
  for (const Alignment& alignment : {brighter, holey}) {
    EXPECT_FALSE(detector.isOrdinary(alignment));
    EXPECT_FALSE(detector.isObstructed(alignment, false));
    EXPECT_TRUE(detector.isObstructed(alignment, true));
  }
  brighter.overlap = 0.3;  // the keyframe has nearly left the view
  EXPECT_FALSE(detector.isObstructed(brighter, true));
}

TEST(LossDetector, ImplausibleMotionsAndEntropiesAreNotBelieved) {
  const LossDetector detector(LossOptions{});
  EXPECT_NE(detector.findAlignmentFault(goodAlignment(), {1.0, pose(0.5, 0, 0), 0.033}), "");
  EXPECT_EQ(detector.findAlignmentFault(goodAlignment(), {1.0, pose(0.5, 0, 0), 0.5}), "");
  EXPECT_NE(detector.findAlignmentFault(goodAlignment(), {1.0, pose(0, 0, 0, 0, 0.5, 0), 0.033}),
            "");
  EXPECT_NE(detector.findAlignmentFault(goodAlignment(), {0.3, pose(0, 0, 0), 0.033}), "");
}

}  // namespace
}  // namespace planecloud

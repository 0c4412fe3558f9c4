// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <stdexcept>

#include "planecloud_slam/frontend_node/dense_tracker.h"
#include "synthetic_scene.h"

namespace planecloud {
namespace {

using synthetic::pose;

class DenseTrackerTest : public ::testing::Test {
 protected:
  RgbdPyramid pyramidAt(const Eigen::Isometry3d& T_world_camera,
                        const synthetic::SceneOptions& scene = {}) const {
    const RgbdFrame frame = synthetic::render(synthetic::camera(), T_world_camera, scene);
    RgbdPyramid pyramid(synthetic::camera(), options_);
    pyramid.assign(frame.grey.view(), frame.depth.view());
    return pyramid;
  }

  Alignment align(const Eigen::Isometry3d& T_world_reference,
                  const Eigen::Isometry3d& T_world_current,
                  const synthetic::SceneOptions& reference_scene,
                  const synthetic::SceneOptions& current_scene) const {
    const TrackingReference reference(pyramidAt(T_world_reference, reference_scene), options_);
    DenseTracker tracker(options_);
    return tracker.align(reference, pyramidAt(T_world_current, current_scene),
                         {{Eigen::Isometry3d::Identity()}, Brightness{}});
  }

  DenseTrackerOptions options_;
};

double translationError(const Alignment& alignment, const Eigen::Isometry3d& truth) {
  return (alignment.T_reference_current.translation() - truth.translation()).norm();
}

double rotationError(const Alignment& alignment, const Eigen::Isometry3d& truth) {
  return rotationAngle(alignment.T_reference_current.inverse() * truth);
}

TEST_F(DenseTrackerTest, FindsTheMotionBetweenExactImages) {
  for (const Eigen::Isometry3d& truth :
       {pose(0.08, 0, 0), pose(0, -0.05, 0.1), pose(0, 0, 0, 0.04, 0, 0), pose(0, 0, 0, 0, 0.08, 0),
        pose(-0.05, 0.03, 0.06, -0.02, 0.03, 0.1)}) {
    const Alignment alignment = align(pose(0, 0, 0), truth, {}, {});
    EXPECT_EQ(alignment.status, AlignmentStatus::kConverged);
    // Grey values are rounded and interpolated: a thirtieth of a pixel at 2 m.
    EXPECT_LT(translationError(alignment, truth), 1e-3) << truth.matrix();
    EXPECT_LT(rotationError(alignment, truth), 5e-4) << truth.matrix();
    EXPECT_GT(alignment.inliers, 0.9);
  }
}

TEST_F(DenseTrackerTest, FollowsAnExposureThatDoubles) {
  const Eigen::Isometry3d truth = pose(0.04, 0.02, 0, 0, 0.03, 0);
  synthetic::SceneOptions dark;
  dark.gain = 0.5;
  dark.offset = 10.0;
  const Alignment alignment = align(pose(0, 0, 0), truth, dark, {});
  EXPECT_LT(translationError(alignment, truth), 2e-3);
  EXPECT_NEAR(alignment.brightness.gain, 2.0, 0.05);
  EXPECT_NEAR(alignment.brightness.offset, -20.0, 3.0);
}

TEST_F(DenseTrackerTest, ConstantBrightnessIsKeptWhenAskedFor) {
  options_.brightness = BrightnessModel::kConstant;
  const Alignment alignment = align(pose(0, 0, 0), pose(0.02, 0, 0), {}, {});
  EXPECT_EQ(alignment.brightness.gain, 1.0);
  EXPECT_EQ(alignment.brightness.offset, 0.0);
}

TEST_F(DenseTrackerTest, SwappingTheImagesInvertsTheMotion) {
  const Eigen::Isometry3d truth = pose(0.05, -0.02, 0.04, 0.01, -0.04, 0.02);
  const Alignment there = align(pose(0, 0, 0), truth, {}, {});
  const Alignment back = align(truth, pose(0, 0, 0), {}, {});
  const Eigen::Isometry3d loop = there.T_reference_current * back.T_reference_current;
  EXPECT_LT(loop.translation().norm(), 1.5e-3);
  EXPECT_LT(rotationAngle(loop), 1e-3);
}

TEST_F(DenseTrackerTest, TheSameImagesGiveTheSameBits) {
  const Eigen::Isometry3d truth = pose(0.05, 0, 0.02);
  const Alignment first = align(pose(0, 0, 0), truth, {}, {});
  const Alignment second = align(pose(0, 0, 0), truth, {}, {});
  EXPECT_TRUE(first.T_reference_current.matrix() == second.T_reference_current.matrix());
  EXPECT_TRUE(first.information == second.information);
}

TEST_F(DenseTrackerTest, InformationIsHonestAboutSensorNoise) {
  const Eigen::Isometry3d truth = pose(0.05, 0.01, -0.03, 0.01, 0.03, -0.02);
  double sum = 0.0;
  constexpr int kTrials = 16;
  for (unsigned trial = 0; trial < kTrials; ++trial) {
    synthetic::SceneOptions reference{3.0, 0.006, 1.0, 0.0, 2 * trial};
    synthetic::SceneOptions current{3.0, 0.006, 1.0, 0.0, 2 * trial + 1};
    const Alignment alignment = align(pose(0, 0, 0), truth, reference, current);
    const Vector6d error = logSe3(alignment.T_reference_current.inverse() * truth);
    sum += error.dot(alignment.information * error);
  }
  // Six degrees of freedom; the spread over image blocks is itself an estimate.
  EXPECT_GT(sum / kTrials, 2.0);
  EXPECT_LT(sum / kTrials, 14.0);
}

TEST_F(DenseTrackerTest, ABareWallLeavesItsPlaneUncertain) {
  Image<std::uint8_t> grey(320, 240, 120);
  Image<float> depth(320, 240, 2.0F);
  RgbdPyramid pyramid(synthetic::camera(), options_);
  pyramid.assign(grey.view(), depth.view());
  DenseTracker tracker(options_);
  const Alignment alignment = tracker.align(TrackingReference(pyramid, options_), pyramid,
                                            {{Eigen::Isometry3d::Identity()}, Brightness{}});
  EXPECT_NE(alignment.status, AlignmentStatus::kTooFewPoints);
  // Along the wall there is neither texture nor slope; towards it there is depth.
  EXPECT_LT(alignment.normal_matrix(0, 0), 1e-3 * alignment.normal_matrix(2, 2));
  EXPECT_LT(alignment.normal_matrix(5, 5), 1e-3 * alignment.normal_matrix(3, 3));
}

TEST_F(DenseTrackerTest, NothingInCommonIsTooFewPoints) {
  const TrackingReference reference(pyramidAt(pose(0, 0, 0)), options_);
  DenseTracker tracker(options_);
  const Alignment alignment = tracker.align(reference, pyramidAt(pose(0, 0, 0)),
                                            {{pose(0, 0, 0, 0, 3.0, 0)}, Brightness{}});
  EXPECT_EQ(alignment.status, AlignmentStatus::kTooFewPoints);
  EXPECT_EQ(alignment.overlap, 0.0);
}

TEST_F(DenseTrackerTest, TheBetterOfTwoStartsIsTaken) {
  const Eigen::Isometry3d truth = pose(0.2, 0, 0, 0, 0.3, 0);
  const TrackingReference reference(pyramidAt(pose(0, 0, 0)), options_);
  DenseTracker tracker(options_);
  const Alignment alignment =
      tracker.align(reference, pyramidAt(truth),
                    {{pose(-0.5, 0, 0, 0, -0.5, 0), pose(0.19, 0, 0, 0, 0.29, 0)}, Brightness{}});
  EXPECT_LT(translationError(alignment, truth), 3e-3);
}

TEST_F(DenseTrackerTest, AStrongPriorHoldsTheGuess) {
  options_.prior_translation = 1e-6;
  options_.prior_rotation = 1e-6;
  const Alignment alignment = align(pose(0, 0, 0), pose(0.05, 0, 0), {}, {});
  EXPECT_LT(alignment.T_reference_current.translation().norm(), 1e-4);
}

TEST_F(DenseTrackerTest, RefusesForeignPyramidsAndMissingStarts) {
  const TrackingReference reference(pyramidAt(pose(0, 0, 0)), options_);
  DenseTracker tracker(options_);
  EXPECT_THROW((void)tracker.align(reference, pyramidAt(pose(0, 0, 0)), {}), std::invalid_argument);
  options_.levels = 2;
  EXPECT_THROW((void)tracker.align(reference, pyramidAt(pose(0, 0, 0)),
                                   {{Eigen::Isometry3d::Identity()}, Brightness{}}),
               std::invalid_argument);
}

}  // namespace
}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <vector>

#include "planecloud_slam/frontend_node/frontend.h"
#include "planecloud_slam/frontend_node/keyframe_compressor.h"
#include "planecloud_slam/plane_fit/plane_cloud_codec.h"
#include "synthetic_scene.h"

namespace planecloud {
namespace {

using synthetic::pose;

constexpr double kFramePeriod = 1.0 / 15.0;

/// A path to the side and forwards with a slow turn: 2.5 cm a frame.
Eigen::Isometry3d pathPose(int i) {
  return pose(0.02 * i - 0.3, 0.003 * i, 0.015 * i - 0.2, 0, -0.008 * i, 0.002 * i);
}

RgbdFrame pathFrame(int i) {
  synthetic::SceneOptions scene;
  scene.grey_noise = 2.0;
  scene.depth_noise = 0.004;
  scene.seed = static_cast<unsigned>(i);
  RgbdFrame frame = synthetic::render(synthetic::camera(), pathPose(i), scene);
  frame.stamp = 100.0 + i * kFramePeriod;
  return frame;
}

RgbdFrame blackFrame(int i) {
  RgbdFrame frame = pathFrame(i);
  frame.grey = Image<std::uint8_t>(320, 240, 0);
  return frame;
}

Frontend makeFrontend(const FrontendOptions& options = {}) {
  return Frontend(options, synthetic::camera(), "robot1", 42);
}

/// Error of the estimated motion since frame `first` [m].
double driftSince(int first, int i, const FrameResult& at_first, const FrameResult& at_i) {
  const Eigen::Isometry3d truth = pathPose(first).inverse() * pathPose(i);
  const Eigen::Isometry3d estimate = at_first.T_odom_camera.inverse() * at_i.T_odom_camera;
  return (truth.inverse() * estimate).translation().norm();
}

TEST(Frontend, TheFirstCameraIsLevelAndLooksAlongX) {
  Frontend frontend = makeFrontend();
  const FrameResult result = frontend.track(pathFrame(0));
  EXPECT_EQ(result.status, TrackingStatus::kInitialised);
  EXPECT_TRUE((result.T_odom_camera * Eigen::Vector3d::UnitZ()).isApprox(Eigen::Vector3d::UnitX()));
  EXPECT_TRUE(
      (result.T_odom_camera * Eigen::Vector3d::UnitY()).isApprox(-Eigen::Vector3d::UnitZ()));
}

TEST(Frontend, StartsWhereItIsTold) {
  Frontend frontend = makeFrontend();
  frontend.setNextPose(pose(1, 2, 3));
  EXPECT_TRUE(frontend.track(pathFrame(0)).T_odom_camera.isApprox(pose(1, 2, 3)));
}

TEST(Frontend, FollowsAPathThroughSeveralKeyframes) {
  Frontend frontend = makeFrontend();
  const FrameResult first = frontend.track(pathFrame(0));
  FrameResult last;
  for (int i = 1; i <= 30; ++i) {
    last = frontend.track(pathFrame(i));
    ASSERT_EQ(last.status, TrackingStatus::kTracked) << i << ": " << last.reason;
  }
  EXPECT_LT(driftSince(0, 30, first, last), 0.008);  // 1 % of the path
  frontend.finish();
  const std::vector<CompletedKeyframe> completed = frontend.takeCompleted();
  ASSERT_GE(completed.size(), 3U);
  for (std::size_t k = 0; k < completed.size(); ++k) {
    const Keyframe& keyframe = completed[k].keyframe;
    EXPECT_EQ(keyframe.id, (KeyframeId{"robot1", 42, static_cast<std::uint32_t>(k)}));
    ASSERT_EQ(keyframe.edges.size(), k == 0 ? 0U : 1U);
    if (k == 0) continue;
    const RelativePoseEdge& edge = keyframe.edges.front();
    EXPECT_EQ(edge.other, completed[k - 1].keyframe.id);
    EXPECT_TRUE((completed[k - 1].keyframe.T_odom_camera * edge.T_other_this)
                    .isApprox(keyframe.T_odom_camera, 1e-9));
    EXPECT_GT(edge.information.llt().matrixL().determinant(), 0.0);
  }
  EXPECT_TRUE(frontend.takeCompleted().empty());
}

TEST(Frontend, TheSameFramesGiveTheSameBits) {
  Frontend a = makeFrontend();
  Frontend b = makeFrontend();
  for (int i = 0; i < 12; ++i) {
    const FrameResult in_a = a.track(pathFrame(i));
    const FrameResult in_b = b.track(pathFrame(i));
    EXPECT_TRUE(in_a.T_odom_camera.matrix() == in_b.T_odom_camera.matrix());
    EXPECT_TRUE(in_a.information == in_b.information);
  }
}

TEST(Frontend, ShortDarknessIsLostAndRegainedWithoutAJump) {
  Frontend frontend = makeFrontend();
  const FrameResult first = frontend.track(pathFrame(0));
  for (int i = 1; i <= 3; ++i) (void)frontend.track(pathFrame(i));
  for (int i = 4; i <= 7; ++i) {
    const FrameResult dark = frontend.track(blackFrame(i));
    EXPECT_EQ(dark.status, TrackingStatus::kLost);
    EXPECT_NE(dark.reason.find("blank"), std::string::npos);
    EXPECT_LT(driftSince(0, 3, first, dark), 0.005);  // the pose stays where it was known
  }
  const FrameResult light = frontend.track(pathFrame(8));
  ASSERT_EQ(light.status, TrackingStatus::kTracked) << light.reason;
  EXPECT_LT(driftSince(0, 8, first, light), 0.005);
}

/// What a camera sees that was turned around: nothing of the path.
RgbdFrame elsewhere(int i, double turn = 2.5) {
  RgbdFrame frame = synthetic::render(synthetic::camera(), pose(0, 0, 0, 0, turn, 0));
  frame.stamp = pathFrame(i).stamp;
  return frame;
}

TEST(Frontend, LongLossBeginsANewSegment) {
  FrontendOptions options;
  options.lost.new_segment_after = 0.5;
  Frontend frontend = makeFrontend(options);
  (void)frontend.track(pathFrame(0));
  (void)frontend.track(pathFrame(1));
  for (int i = 3; i < 10; ++i) {
    const FrameResult lost = frontend.track(elsewhere(i));
    EXPECT_EQ(lost.status, TrackingStatus::kLost);
    EXPECT_EQ(lost.segment, 0);
  }
  FrameResult again;
  for (int i = 10; i < 13 && again.status == TrackingStatus::kLost; ++i) {
    again = frontend.track(elsewhere(i));
  }
  EXPECT_EQ(again.status, TrackingStatus::kInitialised);
  EXPECT_EQ(again.reference.number, 1U);
  EXPECT_EQ(again.segment, 1);
  frontend.finish();
  const std::vector<CompletedKeyframe> completed = frontend.takeCompleted();
  ASSERT_EQ(completed.size(), 2U);
  EXPECT_TRUE(completed[1].keyframe.edges.empty());
}

TEST(Frontend, NumbersEverySegmentAnew) {
  FrontendOptions options;
  options.lost.new_segment_after = 0.3;
  Frontend frontend = makeFrontend(options);
  int i = 0;
  const auto show = [&](const std::function<RgbdFrame()>& look, TrackingStatus awaited) {
    FrameResult result;
    for (int tries = 0; tries < 20; ++tries) {
      RgbdFrame frame = look();
      frame.stamp = pathFrame(i++).stamp;
      result = frontend.track(frame);
      if (result.status == awaited) break;
    }
    EXPECT_EQ(result.status, awaited) << result.reason;
    return result.segment;
  };
  const auto onThePath = [&] { return pathFrame(0); };
  EXPECT_EQ(show(onThePath, TrackingStatus::kInitialised), 0);
  EXPECT_EQ(show([&] { return elsewhere(i); }, TrackingStatus::kInitialised), 1);
  EXPECT_EQ(show(onThePath, TrackingStatus::kRelocalised), 0);
  EXPECT_EQ(show([&] { return elsewhere(i, 4.5); }, TrackingStatus::kInitialised), 2);
}

TEST(Frontend, DarknessAloneOpensNoSegment) {
  Frontend frontend = makeFrontend();
  (void)frontend.track(pathFrame(0));
  for (int i = 1; i < 40; ++i) (void)frontend.track(blackFrame(i));
  RgbdFrame light = pathFrame(1);
  light.stamp = pathFrame(40).stamp;
  EXPECT_EQ(frontend.track(light).status, TrackingStatus::kTracked);
}

TEST(Frontend, ComesBackToAnEarlierKeyframe) {
  Frontend frontend = makeFrontend();
  const FrameResult first = frontend.track(pathFrame(0));
  for (int i = 1; i <= 40; ++i) (void)frontend.track(pathFrame(i));
  RgbdFrame kidnapped = pathFrame(2);
  kidnapped.stamp = pathFrame(41).stamp;
  const FrameResult found = frontend.track(kidnapped);
  ASSERT_EQ(found.status, TrackingStatus::kRelocalised) << found.reason;
  EXPECT_EQ(found.segment, 0);
  EXPECT_LT(driftSince(0, 2, first, found), 0.02);
  for (int i = 3; i <= 20; ++i) {
    RgbdFrame frame = pathFrame(i);
    frame.stamp = pathFrame(39 + i).stamp;
    ASSERT_EQ(frontend.track(frame).status, TrackingStatus::kTracked) << i;
  }
  frontend.finish();
  const std::vector<CompletedKeyframe> completed = frontend.takeCompleted();
  int jumps = 0;
  for (std::size_t k = 1; k < completed.size(); ++k) {
    ASSERT_EQ(completed[k].keyframe.edges.size(), 1U);
    const std::uint32_t before = completed[k].keyframe.edges.front().other.number;
    EXPECT_LT(before, completed[k].keyframe.id.number);
    jumps += before + 1 < completed[k].keyframe.id.number ? 1 : 0;
  }
  EXPECT_EQ(jumps, 1);  // the one after the jump hangs on the keyframe found again
}

TEST(Frontend, WheelsBridgeWhatTheCameraDoesNotSee) {
  FrontendOptions options;
  options.lost.new_segment_after = 0.3;
  Frontend frontend = makeFrontend(options);
  const FrameResult first = frontend.track(pathFrame(0));
  for (int i = 1; i <= 10; ++i) {
    (void)frontend.track(pathFrame(i), pathPose(i - 1).inverse() * pathPose(i));
  }
  for (int i = 11; i <= 14; ++i) {
    const FrameResult dark = frontend.track(blackFrame(i), pathPose(i - 1).inverse() * pathPose(i));
    EXPECT_EQ(dark.status, TrackingStatus::kLost);
    EXPECT_LT(driftSince(0, i, first, dark), 0.01);
  }
  // Then the camera looks the other way, as the wheels say.
  Eigen::Isometry3d T_previous_current = pathPose(14).inverse() * pose(0, 0, 0, 0, 2.5, 0);
  FrameResult bridged;
  for (int i = 15; i < 25 && bridged.status == TrackingStatus::kLost; ++i) {
    bridged = frontend.track(elsewhere(i), T_previous_current);
    T_previous_current = Eigen::Isometry3d::Identity();
  }
  EXPECT_EQ(bridged.status, TrackingStatus::kRelocalised);
  EXPECT_EQ(bridged.segment, 0);
  frontend.finish();
  const Keyframe last = frontend.takeCompleted().back().keyframe;
  ASSERT_EQ(last.edges.size(), 1U);
  const Eigen::Isometry3d T = last.edges.front().T_other_this;
  // It claims no more than 5 % of the turn.
  EXPECT_LT(last.edges.front().information(4, 4), 1.0 / std::pow(0.05 * rotationAngle(T), 2));
}

TEST(Frontend, NothingIsOpenedOnUselessImages) {
  Frontend frontend = makeFrontend();
  EXPECT_EQ(frontend.track(blackFrame(0)).status, TrackingStatus::kLost);
  RgbdFrame no_depth = pathFrame(1);
  no_depth.depth = Image<float>(320, 240, std::numeric_limits<float>::quiet_NaN());
  EXPECT_EQ(frontend.track(no_depth).status, TrackingStatus::kLost);
  frontend.finish();
  EXPECT_TRUE(frontend.takeCompleted().empty());
  EXPECT_EQ(frontend.track(pathFrame(2)).status, TrackingStatus::kInitialised);
}

TEST(Frontend, TimeRunningBackwardsBeginsANewSegment) {
  Frontend frontend = makeFrontend();
  (void)frontend.track(pathFrame(5));
  (void)frontend.track(pathFrame(6));
  EXPECT_EQ(frontend.track(pathFrame(0)).status, TrackingStatus::kInitialised);
  EXPECT_EQ(frontend.takeCompleted().size(), 1U);
}

TEST(Frontend, WheelOdometryCarriesOverAFastTurn) {
  Frontend frontend = makeFrontend();
  (void)frontend.track(pathFrame(0));
  const Eigen::Isometry3d turn = pose(0, 0, 0, 0, 0.4, 0);
  RgbdFrame turned = synthetic::render(synthetic::camera(), pathPose(0) * turn);
  turned.stamp = pathFrame(2).stamp;
  const FrameResult result = frontend.track(turned, pose(0.01, 0, 0, 0, 0.38, 0));
  ASSERT_EQ(result.status, TrackingStatus::kTracked) << result.reason;
  EXPECT_LT(rotationAngle(result.T_reference_camera.inverse() * turn), 2e-3);
}

/// What a camera on a driving robot sees. The room's floor is at y = 2: up is -y of the camera.
RgbdFrame drivingFrame(int i) {
  synthetic::SceneOptions scene;
  scene.grey_noise = 2.0;
  scene.depth_noise = 0.004;
  scene.seed = static_cast<unsigned>(i);
  const Eigen::Isometry3d T = pose(0.02 * i - 0.3, 0, 0.015 * i - 0.2, 0, -0.008 * i, 0);
  RgbdFrame frame = synthetic::render(synthetic::camera(), T, scene);
  frame.stamp = 100.0 + i * kFramePeriod;
  return frame;
}

TEST(Frontend, PlanarMotionKeepsHeightAndTiltExactly) {
  FrontendOptions options;
  options.planar = true;
  Frontend frontend = makeFrontend(options);
  const Eigen::Isometry3d T_odom_first = frontend.track(drivingFrame(0)).T_odom_camera;
  FrameResult last;
  for (int i = 1; i <= 30; ++i) {
    last = frontend.track(drivingFrame(i));
    ASSERT_EQ(last.status, TrackingStatus::kTracked) << i << ": " << last.reason;
    const Eigen::Isometry3d T_first_camera = T_odom_first.inverse() * last.T_odom_camera;
    EXPECT_NEAR(T_first_camera.translation().y(), 0.0, 1e-9) << i;
    EXPECT_TRUE((T_first_camera.linear() * Eigen::Vector3d::UnitY())
                    .isApprox(Eigen::Vector3d::UnitY(), 1e-9))
        << i;
  }
  const Eigen::Isometry3d T_first_last = T_odom_first.inverse() * last.T_odom_camera;
  const Eigen::Isometry3d truth = pose(-0.3, 0, -0.2).inverse() * pose(0.3, 0, 0.25, 0, -0.24, 0);
  EXPECT_LT((truth.inverse() * T_first_last).translation().norm(), 0.008);  // 1 % of the path
}

TEST(Frontend, NamesTheCureForImagesOfAnotherSize) {
  Frontend frontend = makeFrontend();
  RgbdFrame frame = pathFrame(0);
  frame.depth = Image<float>(160, 120, 1.0F);
  try {
    (void)frontend.track(frame);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("160 x 120"), std::string::npos);
  }
}

TEST(Frontend, DistortedImagesAreTrackedInTheRectifiedCamera) {
  CameraIntrinsics camera = synthetic::camera();
  camera.distortion[0] = 0.05;
  Frontend frontend(FrontendOptions{}, camera, "robot1", 1);
  (void)frontend.track(pathFrame(0));
  frontend.finish();
  EXPECT_EQ(frontend.takeCompleted().at(0).camera, camera.rectified());
}

TEST(KeyframeCompressor, FitsEncodesAndDescribesAKeyframe) {
  Frontend frontend = makeFrontend();
  (void)frontend.track(pathFrame(0));
  frontend.finish();
  KeyframeCompressor compressor{FrontendOptions{}};
  const Keyframe keyframe = compressor.compress(frontend.takeCompleted().at(0));
  EXPECT_EQ(keyframe.id.robot, "robot1");
  EXPECT_GT(keyframe.planes.plane_count, 10U);
  EXPECT_GT(keyframe.planes.statistics.coverage, 0.5);
  EXPECT_EQ(decode(keyframe.planes).tiles.size(), keyframe.planes.plane_count);
  EXPECT_FALSE(keyframe.descriptor.empty());
}

}  // namespace
}  // namespace planecloud

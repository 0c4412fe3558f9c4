// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "planecloud_slam/frontend_node/last_good_image.h"
#include "synthetic_scene.h"

namespace planecloud {
namespace {

using synthetic::pose;

Alignment alignmentOf(const Eigen::Isometry3d& T, double translation, double rotation) {
  Alignment alignment;
  alignment.T_reference_current = T;
  Vector6d diagonal;
  diagonal << 1.0, 4.0, 9.0, 1.0, 2.0, 3.0;
  diagonal.head<3>() /= translation * translation;
  diagonal.tail<3>() /= rotation * rotation;
  alignment.information = diagonal.asDiagonal();
  return alignment;
}

const Eigen::Isometry3d kImage =
    pose(0.2, -0.1, 0.3) * Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitY());
const Eigen::Isometry3d kLive =
    pose(0.5, 0.2, -0.4) * Eigen::AngleAxisd(-0.4, Eigen::Vector3d::UnitX());

TEST(LastGoodImage, PassesMotionsAndErrorsOnToTheKeyframe) {
  const Alignment to_keyframe = alignmentOf(kImage, 0.02, 0.01);
  const Alignment to_image = alignmentOf(kLive, 0.01, 0.02);
  LastGoodImage image;
  image.set(to_keyframe);
  const Alignment passed = image.toKeyframe(to_image);
  EXPECT_TRUE(passed.T_reference_current.isApprox(kImage * kLive, 1e-12));

  // As many motions with such errors spread.
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  const auto draw = [&](const Alignment& alignment) {
    Vector6d xi;
    for (Eigen::Index i = 0; i < 6; ++i) {
      xi[i] = normal(random) / std::sqrt(alignment.information(i, i));
    }
    return Eigen::Isometry3d(alignment.T_reference_current * expSe3(xi));
  };
  constexpr int kDraws = 20000;
  Matrix6d spread = Matrix6d::Zero();
  for (int i = 0; i < kDraws; ++i) {
    const Vector6d error =
        logSe3(passed.T_reference_current.inverse() * draw(to_keyframe) * draw(to_image));
    spread += error * error.transpose() / kDraws;
  }
  const Matrix6d covariance = passed.information.inverse();
  // 1 % of sampling, the rest for what is not linear.
  EXPECT_LT((spread - covariance).norm(), 0.03 * covariance.norm());
}

TEST(LastGoodImage, IsAPlaceOfItsOwnUntilTheNextKeyframe) {
  const CameraIntrinsics camera = synthetic::camera();
  RgbdPyramid pyramid(camera, DenseTrackerOptions());
  const RgbdFrame frame = synthetic::render(camera, pose(0, 0, 0));
  pyramid.assign(frame.grey.view(), frame.depth.view());
  KeyframeView keyframe{{"robot1", 1, 5}, 2, pose(1, 2, 3), pyramid, {}};
  LastGoodImage image;
  EXPECT_FALSE(image.isSet());
  image.set(alignmentOf(kImage, 0.02, 0.01));
  ASSERT_TRUE(image.isSet());
  const ExpectedPlace place =
      image.place(keyframe, pyramid, DenseTrackerOptions(), {kImage, kLive});
  EXPECT_EQ(place.view->segment, 2);
  EXPECT_TRUE(place.view->T_odom_camera.isApprox(pose(1, 2, 3) * kImage, 1e-12));
  ASSERT_EQ(place.T_view_live.size(), 2U);
  EXPECT_TRUE(place.T_view_live[0].isApprox(Eigen::Isometry3d::Identity(), 1e-12));
  EXPECT_TRUE(place.T_view_live[1].isApprox(kImage.inverse() * kLive, 1e-12));
  EXPECT_TRUE(image.isAt({place.view, place.reference, Alignment()}));
  image.forget();
  EXPECT_FALSE(image.isSet());
  EXPECT_FALSE(image.isAt({place.view, place.reference, Alignment()}));
}

}  // namespace
}  // namespace planecloud

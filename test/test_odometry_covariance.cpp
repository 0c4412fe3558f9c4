// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "planecloud_slam/frontend_node/odometry_covariance.h"

namespace planecloud {
namespace {

FrameResult initialised(int segment = 0) {
  FrameResult result;
  result.status = TrackingStatus::kInitialised;
  result.reference = {"robot", 1, 0};
  result.segment = segment;
  return result;
}

/// A frame `distance` metres to the right of keyframe `number`, known to 1 cm and 0.01 rad.
FrameResult tracked(std::uint32_t number, double distance) {
  FrameResult result;
  result.status = TrackingStatus::kTracked;
  result.reference = {"robot", 1, number};
  result.T_reference_camera.translation().x() = distance;
  result.information = 1e4 * Matrix6d::Identity();
  return result;
}

TEST(OdometryCovariance, BeginsWithNone) {
  OdometryCovariance covariance;
  EXPECT_TRUE(covariance.update(initialised()).isZero());
}

TEST(OdometryCovariance, IsTheKeyframesAndTheFramesTogether) {
  OdometryCovariance covariance;
  static_cast<void>(covariance.update(initialised()));
  EXPECT_TRUE(covariance.update(tracked(0, 0.2)).isApprox(1e-4 * Matrix6d::Identity(), 1e-9))
      << "the first keyframe is known exactly";
  const Matrix6d next = covariance.update(tracked(1, 0.0));
  EXPECT_TRUE(next.isApprox(2e-4 * Matrix6d::Identity(), 1e-9));
}

TEST(OdometryCovariance, TurnsACameraThatMovedOnIntoOneThatMayBeElsewhere) {
  OdometryCovariance covariance;
  static_cast<void>(covariance.update(initialised()));
  static_cast<void>(covariance.update(tracked(0, 0.2)));
  const Matrix6d far = covariance.update(tracked(1, 2.0));
  EXPECT_NEAR(far(0, 0), 2e-4, 1e-9) << "along the lever";
  EXPECT_NEAR(far(1, 1), 2e-4 + 4.0 * 1e-4, 1e-9) << "across it: 2 m times 0.01 rad";
}

TEST(OdometryCovariance, SaysWhatIsNotKnown) {
  OdometryCovariance covariance;
  static_cast<void>(covariance.update(initialised()));
  FrameResult lost = tracked(0, 0.0);
  lost.status = TrackingStatus::kLost;
  EXPECT_EQ(covariance.update(lost)(0, 0), OdometryCovariance::kUnknown);
  EXPECT_LT(covariance.update(tracked(0, 0.1))(0, 0), 1e-3) << "found again";
  EXPECT_EQ(covariance.update(initialised(1))(5, 5), OdometryCovariance::kUnknown);
  FrameResult corridor = tracked(0, 0.0);
  corridor.information(2, 2) = 0.0;
  OdometryCovariance fresh;
  static_cast<void>(fresh.update(initialised()));
  EXPECT_EQ(fresh.update(corridor)(2, 2), OdometryCovariance::kUnknown);
}

}  // namespace
}  // namespace planecloud

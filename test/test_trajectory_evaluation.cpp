// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "planecloud_slam/plane_fit/se3.h"
#include "planecloud_slam/rosbags/trajectory_evaluation.h"

namespace planecloud {
namespace {

constexpr double kRate = 100.0;  // [Hz]

/// Ten seconds along a curve in space, turning.
Trajectory curve(double start = 100.0) {
  Trajectory trajectory;
  for (int i = 0; i <= 1000; ++i) {
    const double t = i / kRate;
    StampedPose pose;
    pose.stamp = start + t;
    pose.pose.translation() = Eigen::Vector3d(0.4 * t, std::sin(0.7 * t), 0.2 * std::cos(1.1 * t));
    pose.pose.linear() = expSo3({0.1 * t, 0.3 * std::sin(t), -0.2 * t}).toRotationMatrix();
    trajectory.push_back(pose);
  }
  return trajectory;
}

Eigen::Isometry3d somePose() {
  Vector6d xi;
  xi << 3.0, -1.0, 0.5, 0.3, -1.2, 2.0;
  return expSe3(xi);
}

Trajectory moved(const Eigen::Isometry3d& T, Trajectory trajectory) {
  for (StampedPose& pose : trajectory) pose.pose = T * pose.pose;
  return trajectory;
}

Trajectory noisy(Trajectory trajectory, double sigma, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, sigma);
  for (StampedPose& pose : trajectory) {
    pose.pose.translation() += Eigen::Vector3d(normal(random), normal(random), normal(random));
  }
  return trajectory;
}

TEST(TrajectoryEvaluation, APerfectEstimateInAnotherFrameHasNoError) {
  const TrajectoryErrors errors = evaluateTrajectories({{curve(), moved(somePose(), curve())}});
  EXPECT_EQ(errors.pairs, 1001U);
  EXPECT_LT(errors.ate_rmse, 1e-9);
  EXPECT_LT(errors.rpe_trans_rmse, 1e-9);
  EXPECT_LT(errors.rpe_rot_rmse, 1e-6);
  EXPECT_LT(errors.end_drift, 1e-6);
}

TEST(TrajectoryEvaluation, TheAbsoluteErrorOfWhiteNoiseIsItsDeviation) {
  const TrajectoryErrors errors = evaluateTrajectories({{curve(), noisy(curve(), 0.02, 1)}});
  // 3003 samples: 1.3 % standard error; alignment takes 6 degrees of freedom, 0.1 %.
  EXPECT_NEAR(errors.ate_rmse, 0.02 * std::sqrt(3.0), 0.0015);
  EXPECT_NEAR(errors.rpe_trans_rmse, 0.02 * std::sqrt(6.0), 0.0025);
}

TEST(TrajectoryEvaluation, NoErrorDependsOnTheEstimatesFrame) {
  const Trajectory estimate = noisy(curve(), 0.05, 2);
  const TrajectoryErrors a = evaluateTrajectories({{curve(), estimate}});
  const TrajectoryErrors b = evaluateTrajectories({{curve(), moved(somePose(), estimate)}});
  EXPECT_NEAR(a.ate_rmse, b.ate_rmse, 1e-9);
  EXPECT_NEAR(a.rpe_trans_rmse, b.rpe_trans_rmse, 1e-9);
  EXPECT_NEAR(a.end_drift, b.end_drift, 1e-9);
}

TEST(TrajectoryEvaluation, AConstantSlipShowsPerSecond) {
  const Trajectory truth = curve();
  Trajectory estimate = truth;
  Vector6d slip = Vector6d::Zero();
  slip(5) = 0.05 / kRate;  // 0.05 rad a second about the optical axis
  for (std::size_t i = 1; i < estimate.size(); ++i) {
    estimate[i].pose =
        estimate[i - 1].pose * truth[i - 1].pose.inverse() * truth[i].pose * expSe3(slip);
  }
  const TrajectoryErrors errors = evaluateTrajectories({{truth, estimate}});
  EXPECT_NEAR(errors.rpe_rot_rmse, 0.05, 0.002);
}

TEST(TrajectoryEvaluation, ScaleIsNotAligned) {
  Trajectory estimate = curve();
  for (StampedPose& pose : estimate) pose.pose.translation() *= 1.1;
  EXPECT_GT(evaluateTrajectories({{curve(), estimate}}).ate_rmse, 0.1);
}

TEST(TrajectoryEvaluation, SeveralTrajectoriesShareOneAlignment) {
  const Trajectory first = curve();
  const Trajectory second = moved(somePose(), curve(500.0));
  Eigen::Isometry3d T_wrong = Eigen::Isometry3d::Identity();
  T_wrong.translation().z() = 1.0;
  const std::vector<TrajectoryPair> agree = {{first, first}, {second, second}};
  const std::vector<TrajectoryPair> disagree = {{first, first}, {second, moved(T_wrong, second)}};
  EXPECT_LT(evaluateTrajectories(agree).ate_rmse, 1e-9);
  EXPECT_GT(evaluateTrajectories(disagree).ate_rmse, 0.2);
  EXPECT_LT(separatelyAlignedError(disagree), 1e-9);
}

TEST(TrajectoryEvaluation, TheEndDriftIsTheErrorOfTheEndByThePath) {
  Trajectory truth, estimate;
  for (int i = 0; i <= 1000; ++i) {
    StampedPose pose;
    pose.stamp = i / kRate;
    pose.pose.translation().x() = std::max(0.0, pose.stamp - 1.0);  // stands for a second
    truth.push_back(pose);
    pose.pose.translation().y() = 0.02 * pose.pose.translation().x();
    estimate.push_back(pose);
  }
  EXPECT_NEAR(evaluateTrajectories({{truth, estimate}}).end_drift, 0.02, 1e-6);
}

TEST(TrajectoryEvaluation, GroundTruthIsInterpolatedButNotOverGaps) {
  const Trajectory truth = curve();
  EXPECT_TRUE(poseAt(truth, 103.0).has_value());
  EXPECT_FALSE(poseAt(truth, 99.0).has_value());
  EXPECT_FALSE(poseAt(truth, 111.0).has_value());
  const auto between = poseAt(truth, 103.005);
  ASSERT_TRUE(between.has_value());
  // Half of the curvature's 1 m/s^2 over 5 ms squared.
  EXPECT_LT((between->translation() -
             Eigen::Vector3d(0.4 * 3.005, std::sin(0.7 * 3.005), 0.2 * std::cos(1.1 * 3.005)))
                .norm(),
            2e-5);
  Trajectory gap = truth;
  gap.erase(gap.begin() + 300, gap.begin() + 306);  // 70 ms are left open
  EXPECT_FALSE(poseAt(gap, 103.02).has_value());
  gap = truth;
  gap.erase(gap.begin() + 300, gap.begin() + 303);  // 40 ms
  EXPECT_TRUE(poseAt(gap, 103.02).has_value());
  EXPECT_EQ(evaluateTrajectories({{gap, truth}}).pairs, 1001U);
}

TEST(TrajectoryEvaluation, SparseGroundTruthServesItsOwnStamps) {
  Trajectory sparse;
  for (const StampedPose& pose : curve()) {
    if (sparse.empty() || pose.stamp > sparse.back().stamp + 0.495) sparse.push_back(pose);
  }
  EXPECT_EQ(evaluateTrajectories({{sparse, curve()}}).pairs, sparse.size());
}

TEST(TrajectoryEvaluation, WithoutAMatchThereAreNoFigures) {
  const TrajectoryErrors errors = evaluateTrajectories({{curve(0.0), curve(100.0)}});
  EXPECT_EQ(errors.pairs, 0U);
  EXPECT_TRUE(std::isnan(errors.ate_rmse));
  EXPECT_TRUE(std::isnan(errors.end_drift));
}

}  // namespace
}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <random>

#include "icap_corridor.h"
#include "planecloud_slam/icap/icap.h"
#include "synthetic_planes.h"

namespace planecloud {
namespace {

constexpr double kNoise = 1.6e-3;  // inverse depth of one pixel, Kinect class [1/m]

Eigen::Isometry3d roomPose() { return lookAlongX({-1.8, -0.3, 1.2}, 0.1, 0.1); }

/// Two views of one world, and where they are to each other.
struct Pair {
  PlaneSet target;
  PlaneSet source;
  Eigen::Isometry3d T_target_source;
};

Pair makePair(const SyntheticPlanes& world, const Eigen::Isometry3d& T_world_target,
              const Eigen::Isometry3d& T_target_source, double noise, unsigned seed) {
  return {PlaneSet(world.view(T_world_target, noise, 2 * seed)),
          PlaneSet(world.view(T_world_target * T_target_source, noise, 2 * seed + 1)),
          T_target_source};
}

double distanceError(const IcapResult& result, const Eigen::Isometry3d& T_true) {
  return (T_true.inverse() * result.T_target_source).translation().norm();
}

double angleError(const IcapResult& result, const Eigen::Isometry3d& T_true) {
  return rotationAngle(T_true.inverse() * result.T_target_source);
}

TEST(Icap, RecoversKnownMotionsOverNoiseShiftAndDirection) {
  const SyntheticPlanes room = makeRoom();
  std::mt19937 random(1);
  for (const double noise : {0.0, kNoise, 2.0 * kNoise}) {
    for (const double shift : {0.05, 0.2, 0.4}) {
      for (unsigned direction = 0; direction < 3; ++direction) {
        const Eigen::Isometry3d T = randomMotion(shift, 0.5 * shift, random);
        const Pair pair = makePair(room, roomPose(), T, noise, direction);
        const IcapResult result =
            icap(pair.target, pair.source, T * randomMotion(0.1, 0.087, random));
        EXPECT_EQ(result.status, IcapStatus::kConverged);
        // Without noise the steps end at 0.2 mm; with it a plane is known to some millimetres.
        EXPECT_LT(distanceError(result, T), noise > 0.0 ? 0.02 : 1e-3) << noise << " " << shift;
        EXPECT_LT(angleError(result, T), noise > 0.0 ? 0.01 : 5e-4) << noise << " " << shift;
        EXPECT_GT(result.overlap, 0.9);
        EXPECT_LT(result.rms_algebraic_error, 0.02);
      }
    }
  }
}

TEST(Icap, GivesTheInverseWhenTargetAndSourceAreExchanged) {
  const SyntheticPlanes room = makeRoom();
  std::mt19937 random(2);
  for (unsigned seed = 0; seed < 5; ++seed) {
    const Eigen::Isometry3d T = randomMotion(0.2, 0.1, random);
    const Pair pair = makePair(room, roomPose(), T, kNoise, seed);
    const Eigen::Isometry3d guess = T * randomMotion(0.05, 0.05, random);
    const IcapResult forward = icap(pair.target, pair.source, guess);
    const IcapResult backward = icap(pair.source, pair.target, guess.inverse());
    const Eigen::Isometry3d loop = forward.T_target_source * backward.T_target_source;
    // Matching is one-sided, so the two differ within the noise.
    EXPECT_LT(loop.translation().norm(), 0.01);
    EXPECT_LT(rotationAngle(loop), 0.005);
  }
}

TEST(Icap, DoesNotDependOnTheOrderOfTheTiles) {
  const SyntheticPlanes room = makeRoom();
  std::mt19937 random(3);
  const Eigen::Isometry3d T = randomMotion(0.2, 0.1, random);
  const PlaneSet target(room.view(roomPose(), kNoise, 1));
  PlaneCloud cloud = room.view(roomPose() * T, kNoise, 2);
  const IcapResult first = icap(target, PlaneSet(cloud), Eigen::Isometry3d::Identity());
  std::shuffle(cloud.tiles.begin(), cloud.tiles.end(), random);
  const IcapResult second = icap(target, PlaneSet(cloud), Eigen::Isometry3d::Identity());
  EXPECT_EQ(first.T_target_source.matrix(), second.T_target_source.matrix());
  EXPECT_EQ(first.information, second.information);
}

TEST(Icap, DoesNotDependOnTheWorldsFrame) {
  // The same room and views, everything turned and shifted together.
  std::mt19937 random(4);
  const Eigen::Isometry3d T_moved_world = randomMotion(3.0, 1.0, random);
  std::vector<Face> faces = makeRoom().faces();
  for (Face& face : faces) {
    face.centre = T_moved_world * face.centre;
    face.half_a = T_moved_world.linear() * face.half_a;
    face.half_b = T_moved_world.linear() * face.half_b;
  }
  const Eigen::Isometry3d T = randomMotion(0.2, 0.1, random);
  const Pair here = makePair(makeRoom(), roomPose(), T, kNoise, 1);
  const Pair there = makePair(SyntheticPlanes(faces), T_moved_world * roomPose(), T, kNoise, 1);
  const IcapResult first = icap(here.target, here.source, Eigen::Isometry3d::Identity());
  const IcapResult second = icap(there.target, there.source, Eigen::Isometry3d::Identity());
  // 1e-4: tiles are floats, and the iterations stop at steps of 2e-4.
  EXPECT_LT(logSe3(first.T_target_source.inverse() * second.T_target_source).norm(), 1e-4);
}

TEST(Icap, LeavesTheCorridorDirectionUnobserved) {
  const Eigen::Vector3d axis = corridorPose().linear().transpose() * Eigen::Vector3d::UnitX();
  for (unsigned seed = 0; seed < 20; ++seed) {
    const CorridorTrial trial = alignInCorridor(false, seed);
    EXPECT_EQ(trial.result.status, IcapStatus::kDegenerate);
    ASSERT_EQ(trial.result.unobserved.size(), 1U);
    // The twist lies in the source's axes; 0.05: rotation and noise mix in a little.
    const Eigen::Vector3d along = trial.result.T_target_source.linear().transpose() * axis;
    EXPECT_GT(std::abs(trial.result.unobserved[0].head<3>().dot(along)), 0.95);
    EXPECT_LT(std::abs(trial.along), 0.01) << "the guess is kept within 1 cm";
    EXPECT_LT(trial.across, 0.01) << "across it is observed";
    EXPECT_LT(trial.turn, 0.01);
  }
}

TEST(Icap, ObservesTheCorridorDirectionByAnEndWall) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    const CorridorTrial trial = alignInCorridor(true, seed);
    EXPECT_EQ(trial.result.status, IcapStatus::kConverged);
    EXPECT_TRUE(trial.result.unobserved.empty());
    EXPECT_LT(trial.across, 0.01);
    EXPECT_LT(std::abs(trial.beside), 0.02);  // the wall is 4 m away: 25 mm a pixel
  }
}

TEST(Icap, KeepsThreeDirectionsOfOneWall) {
  SyntheticPlanes wall({{{3.0, 0.0, 0.0}, {0.0, 20.0, 0.0}, {0.0, 0.0, 20.0}}});
  const Eigen::Isometry3d pose = lookAlongX({0, 0, 0}, 0.2, 0.1);
  const Pair pair = makePair(wall, pose, Eigen::Isometry3d::Identity(), kNoise, 3);
  std::mt19937 random(7);
  const Eigen::Isometry3d guess = randomMotion(0.1, 0.05, random);
  const IcapResult result = icap(pair.target, pair.source, guess);
  EXPECT_EQ(result.status, IcapStatus::kDegenerate);
  EXPECT_EQ(result.unobserved.size(), 3U);
  const Eigen::Vector3d normal = pose.linear().transpose() * Eigen::Vector3d::UnitX();
  EXPECT_LT(std::abs(result.T_target_source.translation().dot(normal)), 0.01);
  EXPECT_LT((result.T_target_source.linear() * normal).cross(normal).norm(), 0.005);
}

TEST(Icap, HasExactlyNoInformationWhereNothingIsObserved) {
  for (unsigned seed = 0; seed < 5; ++seed) {
    const Pair pair =
        makePair(makeCorridor(false), corridorPose(), Eigen::Isometry3d::Identity(), kNoise, seed);
    const IcapResult result = icap(pair.target, pair.source, pair.T_target_source);
    ASSERT_FALSE(result.unobserved.empty());
    EXPECT_EQ(result.information, result.information.transpose());
    for (const Vector6d& twist : result.unobserved) {
      EXPECT_NEAR(twist.norm(), 1.0, 1e-9);
      // Rounding of products of numbers of the information's size.
      EXPECT_LT((result.information * twist).norm(), 1e-12 * result.information.norm());
    }
    const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(result.information);
    EXPECT_GT(eigen.eigenvalues()(1), 1.0) << "the other directions are known better than to 1 m";
    EXPECT_GT(eigen.eigenvalues()(0), -1e-9 * eigen.eigenvalues()(5));
  }
}

TEST(Icap, StatesAnUncertaintyThatCoversItsError) {
  const SyntheticPlanes room = makeRoom();
  std::mt19937 random(8);
  for (unsigned seed = 0; seed < 10; ++seed) {
    const Eigen::Isometry3d T = randomMotion(0.2, 0.1, random);
    const Pair pair = makePair(room, roomPose(), T, kNoise, seed);
    const IcapResult result = icap(pair.target, pair.source, T * randomMotion(0.1, 0.05, random));
    const Vector6d error = logSe3(result.T_target_source.inverse() * T);
    EXPECT_LT(error.dot(result.information * error), 22.5);  // chi^2 of 6, 99.9 %
    // Nor is it a shrug: one standard deviation is at most 5 cm and 3 degrees.
    const Matrix6d covariance = result.information.inverse();
    EXPECT_LT(covariance.diagonal().head<3>().maxCoeff(), 0.05 * 0.05);
    EXPECT_LT(covariance.diagonal().tail<3>().maxCoeff(), 0.05 * 0.05);
  }
}

TEST(Icap, PaperFormAlignsACleanGenericScene) {
  IcapOptions options;
  options.form = IcapForm::kPaper;
  std::mt19937 random(9);
  const Eigen::Isometry3d T = randomMotion(0.1, 0.03, random);
  const Pair pair = makePair(makeRoom(), roomPose(), T, 0.0, 1);
  const IcapResult result =
      icap(pair.target, pair.source, T * randomMotion(0.05, 0.02, random), options);
  EXPECT_EQ(result.status, IcapStatus::kConverged);
  // Planes that only one of the views saw have no partner, find one all the same, and pull.
  EXPECT_LT(distanceError(result, T), 0.02);
  EXPECT_LT(angleError(result, T), 0.005);
}

TEST(Icap, PaperFormSlidesAlongANoisyCorridorWhereTheRobustFormHolds) {
  // ALGORITHMS sec. 5: noise makes N^T N regular, so the literal solution invents a translation.
  IcapOptions paper;
  paper.form = IcapForm::kPaper;
  double worst_paper = 0.0;
  double worst_robust = 0.0;
  for (unsigned seed = 0; seed < 5; ++seed) {
    const Pair pair =
        makePair(makeCorridor(false), corridorPose(), Eigen::Isometry3d::Identity(), kNoise, seed);
    const Eigen::Isometry3d& T = pair.T_target_source;
    worst_paper = std::max(worst_paper, distanceError(icap(pair.target, pair.source, T, paper), T));
    worst_robust = std::max(worst_robust, distanceError(icap(pair.target, pair.source, T), T));
  }
  EXPECT_GT(worst_paper, 0.1);
  EXPECT_LT(worst_robust, 0.01);
}

TEST(Icap, ReportsTooFewPlanesAndReturnsTheGuess) {
  std::mt19937 random(10);
  const Eigen::Isometry3d guess = randomMotion(0.3, 0.2, random);
  const PlaneSet room(makeRoom().view(roomPose(), kNoise, 1));
  for (const IcapForm form : {IcapForm::kPaper, IcapForm::kRobust}) {
    IcapOptions options;
    options.form = form;
    for (const IcapResult& result :
         {icap(room, PlaneSet(), guess, options), icap(PlaneSet(), room, guess, options)}) {
      EXPECT_EQ(result.status, IcapStatus::kTooFewPlanes);
      EXPECT_EQ(result.T_target_source.matrix(), guess.matrix());
      EXPECT_EQ(result.information, Matrix6d(Matrix6d::Zero()));
    }
  }
}

TEST(Icap, ReportsTooFewPlanesForViewsWithNothingInCommon) {
  const PlaneSet room(makeRoom().view(roomPose(), kNoise, 1));
  Eigen::Isometry3d far = Eigen::Isometry3d::Identity();
  far.translation().x() = 50.0;
  EXPECT_EQ(icap(room, room, far).status, IcapStatus::kTooFewPlanes);
}

TEST(Icap, ReportsDivergenceWhenItLeavesTheNeighbourhoodOfTheGuess) {
  IcapOptions options;
  options.max_correction = 0.02;
  std::mt19937 random(11);
  const Pair pair = makePair(makeRoom(), roomPose(), Eigen::Isometry3d::Identity(), kNoise, 1);
  const IcapResult result =
      icap(pair.target, pair.source, randomMotion(0.1, 0.01, random), options);
  EXPECT_EQ(result.status, IcapStatus::kDiverged);
  EXPECT_EQ(result.information, Matrix6d(Matrix6d::Zero()));
}

TEST(Icap, ReportsDivergenceWhenItDoesNotSettle) {
  IcapOptions options;
  options.max_iterations = 1;
  std::mt19937 random(12);
  const Pair pair = makePair(makeRoom(), roomPose(), Eigen::Isometry3d::Identity(), kNoise, 1);
  EXPECT_EQ(icap(pair.target, pair.source, randomMotion(0.15, 0.1, random), options).status,
            IcapStatus::kDiverged);
}

TEST(Icap, RefusesOptionsOutOfRange) {
  IcapOptions options;
  options.kernel_width = 0.0;
  EXPECT_THROW((void)icap(PlaneSet(), PlaneSet(), Eigen::Isometry3d::Identity(), options),
               std::invalid_argument);
}

}  // namespace
}  // namespace planecloud

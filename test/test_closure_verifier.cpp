// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>

#include "planecloud_slam/backend_node/closure_verifier.h"
#include "planecloud_slam/backend_node/drift_model.h"
#include "planecloud_slam/backend_node/view_overlap.h"
#include "synthetic_planes.h"

namespace planecloud {
namespace {

constexpr double kNoise = 1.5e-3;  // of a pixel's inverse depth [1/m]

const ClosureVerifier kVerifier{ClosureVerificationOptions(), IcapOptions()};

RelativePoseGuess guessAt(const Eigen::Isometry3d& T_target_source, double path) {
  return {T_target_source, driftCovariance(path, DriftOptions())};
}

TEST(ClosureVerifier, AcceptsATruePairFromAGuessOdometryCouldHaveMade) {
  const Eigen::Isometry3d T_world_target = lookAlongX({-2.0, 0.0, 0.8}, 0.0, 0.1);
  const Eigen::Isometry3d T_world_source = lookAlongX({-1.7, 0.2, 0.8}, 0.1, 0.1);
  const PlaneSet target(makeRoom().view(T_world_target, kNoise, 1));
  const PlaneSet source(makeRoom().view(T_world_source, kNoise, 2));
  const Eigen::Isometry3d truth = T_world_target.inverse() * T_world_source;
  Vector6d off;
  off << 0.15, 0.0, -0.1, 0.02, 0.05, 0.0;
  const ClosureCheck check = kVerifier.verify(target, source, guessAt(truth * expSe3(off), 8.0));
  EXPECT_EQ(check.verdict, ClosureVerdict::kAccepted) << toString(check.verdict);
  // The sensor's error floor on real pairs is 12-24 mm.
  EXPECT_LT(logSe3(check.alignment.T_target_source.inverse() * truth).norm(), 0.02);
}

TEST(ClosureVerifier, RejectsATruePairWhereOdometryCannotHaveGone) {
  const Eigen::Isometry3d T_world_camera = lookAlongX({-2.0, 0.0, 0.8}, 0.0, 0.1);
  const PlaneSet target(makeRoom().view(T_world_camera, kNoise, 1));
  const PlaneSet source(makeRoom().view(T_world_camera, kNoise, 2));
  const Eigen::Isometry3d wrong(Eigen::Translation3d(0.0, 0.0, 0.25));
  EXPECT_EQ(kVerifier.verify(target, source, guessAt(wrong, 0.0)).verdict,
            ClosureVerdict::kInconsistent);
}

TEST(ClosureVerifier, RejectsTwoPlacesThatShareOnlyTheirWalls) {
  SyntheticPlanes other({});
  other.addBox({0.0, 0.0, 1.3}, {2.5, 2.0, 1.3});  // the same room, furnished differently
  other.addBox({0.4, 1.3, 0.9}, {0.5, 0.3, 0.9});
  other.addBox({0.9, -0.4, 0.5}, {0.3, 0.4, 0.5});
  const Eigen::Isometry3d T_world_camera = lookAlongX({-2.0, 0.0, 0.8}, 0.0, 0.1);
  const PlaneSet target(makeRoom().view(T_world_camera, kNoise, 1));
  const PlaneSet source(other.view(T_world_camera, kNoise, 2));
  const ClosureVerdict unlocated = kVerifier.verify(target, source, RelativePoseGuess()).verdict;
  EXPECT_TRUE(unlocated == ClosureVerdict::kSeenThrough ||
              unlocated == ClosureVerdict::kLittleOverlap)
      << toString(unlocated);
  const RelativePoseGuess guess = guessAt(Eigen::Isometry3d::Identity(), 5.0);
  EXPECT_NE(kVerifier.verify(target, source, guess).verdict, ClosureVerdict::kAccepted);
}

TEST(ClosureVerifier, NeverClaimsToKnowThePlaceAlongACorridor) {
  const SyntheticPlanes corridor = makeCorridor(false);
  const Eigen::Isometry3d T_world_target = lookAlongX({0.0, 0.0, 0.8}, 0.0, 0.1);
  const Eigen::Isometry3d T_world_source = lookAlongX({0.3, 0.1, 0.8}, 0.05, 0.1);
  const PlaneSet target(corridor.view(T_world_target, kNoise, 1));
  const PlaneSet source(corridor.view(T_world_source, kNoise, 2));
  const Eigen::Isometry3d truth = T_world_target.inverse() * T_world_source;
  const ClosureCheck check = kVerifier.verify(target, source, guessAt(truth, 5.0));
  Vector6d ahead = Vector6d::Zero();  // the corridor's direction in the source's frame
  ahead.head<3>() = T_world_source.linear().transpose() * Eigen::Vector3d::UnitX();
  // Less than a metre's worth of information.
  EXPECT_LT(ahead.dot(check.alignment.information * ahead), 1.0) << toString(check.verdict);
}

TEST(ClosureVerifier, HasNothingToSayOfEmptyKeyframes) {
  EXPECT_EQ(kVerifier.verify(PlaneSet(), PlaneSet(), RelativePoseGuess()).verdict,
            ClosureVerdict::kTooFewPlanes);
}

TEST(AlignmentStarts, SpreadWithTheUncertainty) {
  const Eigen::Isometry3d guess(Eigen::Translation3d(1.0, 0.0, 0.0));
  EXPECT_EQ(alignmentStarts(guessAt(guess, 0.0)).size(), 1u);
  EXPECT_EQ(alignmentStarts(guessAt(guess, 20.0)).size(), 7u);
  EXPECT_EQ(alignmentStarts(RelativePoseGuess()).size(), 7u);
  EXPECT_TRUE(alignmentStarts(guessAt(guess, 20.0)).front().isApprox(guess));
}

TEST(MutualViewOverlap, IsOneForTheSameViewAndZeroBackToBack) {
  const Eigen::Isometry3d T_world_camera = lookAlongX({-2.0, 0.0, 0.8}, 0.0, 0.1);
  const ViewSketch view = sketchView(makeRoom().view(T_world_camera, 0.0, 1));
  EXPECT_DOUBLE_EQ(mutualViewOverlap(view, view, Eigen::Isometry3d::Identity()), 1.0);
  const Eigen::Isometry3d turned(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitY()));
  EXPECT_LT(mutualViewOverlap(view, view, turned), 0.05);
}

}  // namespace
}  // namespace planecloud

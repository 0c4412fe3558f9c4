// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <random>
#include <stdexcept>

#include "planecloud_slam/icap/align_plane_pairs.h"
#include "planecloud_slam/plane_fit/se3.h"
#include "synthetic_planes.h"

namespace planecloud {
namespace {

/// `pi' = T^-T pi`, the paper's rule for planes, as a 4x4 product.
Eigen::Vector4d transformed(const Eigen::Isometry3d& T, const Eigen::Vector4d& plane) {
  return T.inverse().matrix().transpose() * plane;
}

std::vector<PlanePair> randomPairs(const Eigen::Isometry3d& T_target_source, int count,
                                   std::mt19937& random) {
  std::normal_distribution<double> gauss;
  std::vector<PlanePair> pairs;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d n =
        Eigen::Vector3d(gauss(random), gauss(random), gauss(random)).normalized();
    const Eigen::Vector4d source(n.x(), n.y(), n.z(), 2.0 + gauss(random));
    pairs.push_back({transformed(T_target_source, source), source, 0.5 + (i % 3)});
  }
  return pairs;
}

TEST(AlignPlanePairs, RecoversExactMotionsOfAnySize) {
  std::mt19937 random(1);
  for (int i = 0; i < 50; ++i) {
    const Eigen::Isometry3d T = randomMotion(0.1 * i, 0.06 * i, random);
    const PlaneAlignment alignment = alignPlanePairs(randomPairs(T, 5, random));
    // 1e-9: rounding, amplified by random normals that happen to be alike.
    EXPECT_LT(logSe3(T.inverse() * alignment.T_target_source).norm(), 1e-9) << i;
    EXPECT_EQ(alignment.rotation_rank, 3);
    EXPECT_EQ(alignment.translation_rank, 3);
  }
}

TEST(AlignPlanePairs, GivesTheInverseWhenTargetAndSourceAreExchanged) {
  std::mt19937 random(2);
  const Eigen::Isometry3d T = randomMotion(0.5, 0.7, random);
  std::vector<PlanePair> pairs = randomPairs(T, 6, random);
  const Eigen::Isometry3d forward = alignPlanePairs(pairs).T_target_source;
  for (PlanePair& pair : pairs) std::swap(pair.target, pair.source);
  const Eigen::Isometry3d backward = alignPlanePairs(pairs).T_target_source;
  EXPECT_LT(logSe3(forward * backward).norm(), 1e-9);
}

TEST(AlignPlanePairs, NeverReturnsAReflection) {
  // Two normals only: the SVD may well find the mirrored solution first.
  std::mt19937 random(3);
  for (int i = 0; i < 50; ++i) {
    const Eigen::Isometry3d T = randomMotion(0.0, 0.06 * i, random);
    const PlaneAlignment alignment = alignPlanePairs(randomPairs(T, 2, random));
    EXPECT_NEAR(alignment.T_target_source.linear().determinant(), 1.0, 1e-9);
    EXPECT_LT(rotationAngle(T.inverse() * alignment.T_target_source), 1e-7);
    EXPECT_EQ(alignment.rotation_rank, 2);
  }
}

TEST(AlignPlanePairs, LeavesTheTranslationAlongACorridorAtZero) {
  std::mt19937 random(4);
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() = Eigen::Vector3d(0.1, -0.2, 0.3);
  std::vector<PlanePair> pairs;
  for (const Eigen::Vector4d& wall : {Eigen::Vector4d(1, 0, 0, 1.2), Eigen::Vector4d(-1, 0, 0, 1.1),
                                      Eigen::Vector4d(0, -1, 0, 1.3)}) {
    pairs.push_back({transformed(T, wall), wall, 1.0});
  }
  const PlaneAlignment alignment = alignPlanePairs(pairs);
  EXPECT_EQ(alignment.translation_rank, 2);
  EXPECT_LT((alignment.T_target_source.translation() - Eigen::Vector3d(0.1, -0.2, 0)).norm(), 1e-9);
}

TEST(AlignPlanePairs, TruncatesDirectionsBelowTheGivenShareOnly) {
  // The third direction is seen by noise alone: its eigenvalue is 1e-4 of the largest.
  std::vector<PlanePair> pairs;
  const Eigen::Vector3d tilted = Eigen::Vector3d(1, 0, 0.01).normalized();
  for (const Eigen::Vector3d& n : {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0), tilted}) {
    const Eigen::Vector4d plane(n.x(), n.y(), n.z(), 1.0);
    pairs.push_back({plane + Eigen::Vector4d(0, 0, 0, 0.01), plane, 1.0});
  }
  EXPECT_EQ(alignPlanePairs(pairs).translation_rank, 3);
  EXPECT_EQ(alignPlanePairs(pairs, 1e-3).translation_rank, 2);
  // The direction left out is tilted by a few milliradians against z.
  EXPECT_NEAR(alignPlanePairs(pairs, 1e-3).T_target_source.translation().z(), 0.0, 1e-3);
}

TEST(AlignPlanePairs, IgnoresPairsWithoutWeight) {
  std::mt19937 random(5);
  const Eigen::Isometry3d T = randomMotion(0.3, 0.3, random);
  std::vector<PlanePair> pairs = randomPairs(T, 6, random);
  pairs.push_back({Eigen::Vector4d(1, 0, 0, 5), Eigen::Vector4d(0, 1, 0, 1), 0.0});
  EXPECT_LT(logSe3(T.inverse() * alignPlanePairs(pairs).T_target_source).norm(), 1e-9);
}

TEST(AlignPlanePairs, RefusesWrongUse) {
  const Eigen::Vector4d plane(1, 0, 0, 1);
  EXPECT_THROW((void)alignPlanePairs({}), std::invalid_argument);
  EXPECT_THROW((void)alignPlanePairs({{plane, plane, 0.0}}), std::invalid_argument);
  EXPECT_THROW((void)alignPlanePairs({{plane, plane, -1.0}}), std::invalid_argument);
  EXPECT_THROW((void)alignPlanePairs({{plane, plane, 1.0}}, 1.0), std::invalid_argument);
}

}  // namespace
}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <vector>

#include "map_truth.h"
#include "planecloud_slam/backend_node/backend.h"
#include "planecloud_slam/backend_node/coplanarity.h"
#include "synthetic_robot.h"

namespace planecloud {
namespace {

/// A wall 16 m long and 4 m high in the plane y = 2.
SyntheticPlanes makeWall() {
  return SyntheticPlanes({{{0.0, 2.0, 0.0}, {8.0, 0.0, 0.0}, {0.0, 0.0, 2.0}}});
}

/// Another one 6 cm in front of it, of which every view shows a strip at its upper border.
SyntheticPlanes makeWallWithPanel() {
  return SyntheticPlanes({{{0.0, 2.0, 0.0}, {8.0, 0.0, 0.0}, {0.0, 0.0, 2.0}},
                          {{0.0, 1.94, 1.2}, {8.0, 0.0, 0.0}, {0.0, 0.0, 0.8}}});
}

struct Map {
  std::shared_ptr<const MapSnapshot> snapshot;
  BackendStatistics statistics;
  Truth truth;
};

/// Six keyframes along the wall from x = -3 m to x = 3 m, facing it.
Map driveAlong(const SyntheticPlanes& world, const BackendOptions& options) {
  SyntheticRobot robot(world, "robot1", 7);
  Backend backend(options);
  Map map;
  for (double x = -3.0; x < 3.1; x += 1.2) {
    Keyframe keyframe = robot.see(lookAlongX({x, 0.0, 0.0}, 0.5 * M_PI, 0.0));
    map.truth.emplace(keyframe.id, robot.truth.back());
    EXPECT_EQ(backend.insert(std::move(keyframe)).status, InsertionStatus::kInserted);
  }
  map.snapshot = backend.snapshot();
  map.statistics = backend.statistics();
  return map;
}

std::vector<GraphEdge> coplanarEdges(const Map& map) {
  std::vector<GraphEdge> edges;
  for (const GraphEdge& edge : map.snapshot->edges) {
    if (edge.kind == EdgeKind::kCoplanar) edges.push_back(edge);
  }
  return edges;
}

BackendOptions enabled() {
  BackendOptions options;
  options.loop_closure.coplanarity.enabled = true;
  return options;
}

TEST(Coplanarity, TiesPartsOfOneWallInThreeDirections) {
  const Map map = driveAlong(makeWall(), enabled());
  const std::vector<GraphEdge> edges = coplanarEdges(map);
  ASSERT_FALSE(edges.empty());
  EXPECT_EQ(map.statistics.coplanar_edges, edges.size());
  for (const GraphEdge& edge : edges) {
    const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(edge.information);
    // Edges are kept in single precision.
    EXPECT_LT(eigen.eigenvalues()(2), 1e-4 * eigen.eigenvalues()(3));
    const double width = 1.0 / std::sqrt(eigen.eigenvalues()(3));
    EXPECT_LT(width, 0.1);  // of the worst known direction [m, rad]
    const Vector6d error = closureError(edge, map.truth);
    // 99.9 % of chi-square with 3 degrees of freedom.
    EXPECT_LT(error.dot(edge.information * error), 16.3);
  }
}

TEST(Coplanarity, IsNoLoopClosure) {
  const Map map = driveAlong(makeWall(), enabled());
  ASSERT_GT(map.statistics.coplanar_edges, 0u);
  EXPECT_EQ(map.statistics.closures_intra, 0u);
}

TEST(Coplanarity, RefusesAWallWithAnotherSurfaceJustInFrontOfIt) {
  const Map map = driveAlong(makeWallWithPanel(), enabled());
  EXPECT_TRUE(coplanarEdges(map).empty());
}

TEST(Coplanarity, IsOffByDefault) {
  EXPECT_TRUE(coplanarEdges(driveAlong(makeWall(), BackendOptions())).empty());
}

/// A square of 2 m x 2 m seen from 2 m.
FlatSurface square() {
  FlatSurface surface;
  surface.normal = -Eigen::Vector3d::UnitZ();
  surface.centroid = {0.2, -0.1, 2.0};
  surface.axes << 1.0, 0.0, 0.0, -1.0, 0.0, 0.0;
  surface.half_sides = {1.0, 1.0};
  surface.covariance.diagonal() << 1e-4, 2e-4, 3e-4;
  return surface;
}

TEST(Coplanarity, KnowsHowATwistChangesTheResidual) {
  Vector6d turn;
  turn << 1.0, 0.2, 0.05, 0.02, -0.03, 0.4;
  const Eigen::Isometry3d T = expSe3(turn);
  const Coplanarity pair = compareSurfaces(square(), square(), T);
  const double step = 1e-6;
  for (int i = 0; i < 6; ++i) {
    const Eigen::Isometry3d stepped = T * expSe3(step * Vector6d::Unit(i));
    const Eigen::Vector3d slope =
        (compareSurfaces(square(), square(), stepped).residual - pair.residual) / step;
    EXPECT_LT((slope - pair.jacobian.col(i)).norm(), 1e-5);  // of the order of the step
  }
}

TEST(Coplanarity, CorrectsOnlyAcrossThePlane) {
  Vector6d turn;
  turn << 1.0, 0.2, 0.05, 0.02, -0.03, 0.0;
  const Eigen::Isometry3d T = expSe3(turn);
  const Vector6d step = makeCoplanar(compareSurfaces(square(), square(), T), Matrix6d::Identity());
  const Coplanarity after = compareSurfaces(square(), square(), T * expSe3(step));
  EXPECT_LT(after.residual.norm(), 2e-3);  // what a step of 0.06 leaves to second order
  EXPECT_LT(step.norm(), 0.2);
}

TEST(Coplanarity, KnowsLessTheFartherThePartsAreApart) {
  const Eigen::Isometry3d near(Eigen::Translation3d(1.0, 0.0, 0.0));
  const Eigen::Isometry3d far(Eigen::Translation3d(3.0, 0.0, 0.0));
  const Coplanarity one = compareSurfaces(square(), square(), near);
  const Coplanarity other = compareSurfaces(square(), square(), far);
  // The height adds the target's slope, of variance 2e-4, times the way squared.
  EXPECT_NEAR(other.covariance(0, 0) - one.covariance(0, 0), 8.0 * 2e-4, 1e-9);
}

}  // namespace
}  // namespace planecloud

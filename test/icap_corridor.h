// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "planecloud_slam/icap/icap.h"
#include "synthetic_planes.h"

namespace planecloud {

/// What ICaP made of two views of a corridor with a guess 10 cm and 5 degrees off.
struct CorridorTrial {
  IcapResult result;
  double along = 0.0;   ///< camera centre against the guess, along the corridor [m]
  double across = 0.0;  ///< camera centre against the truth, across the corridor [m]
  double beside = 0.0;  ///< camera centre against the truth, along the corridor [m]
  double turn = 0.0;    ///< rotation against the truth [rad]
};

/// The view both trials look from; the corridor runs along the world's x.
inline Eigen::Isometry3d corridorPose() { return lookAlongX({0.0, 0.1, 1.2}, 0.1, 0.1); }

/// One trial by seed, with Kinect-class noise.
inline CorridorTrial alignInCorridor(bool end_wall, unsigned seed,
                                     const IcapOptions& options = IcapOptions()) {
  constexpr double kNoise = 1.6e-3;  // inverse depth of one pixel [1/m]
  const SyntheticPlanes corridor = makeCorridor(end_wall);
  std::mt19937 random(seed + 1);
  const Eigen::Isometry3d T = randomMotion(0.25, 0.15, random);
  const Eigen::Isometry3d guess = T * randomMotion(0.1, 0.087, random);
  const PlaneSet target(corridor.view(corridorPose(), kNoise, 2 * seed), options.planes);
  const PlaneSet source(corridor.view(corridorPose() * T, kNoise, 2 * seed + 1), options.planes);
  CorridorTrial trial;
  trial.result = icap(target, source, guess, options);
  const Eigen::Vector3d axis = corridorPose().linear().transpose() * Eigen::Vector3d::UnitX();
  const Eigen::Isometry3d& found = trial.result.T_target_source;
  const Eigen::Vector3d error = found.translation() - T.translation();
  trial.along = axis.dot(found.translation() - guess.translation());
  trial.beside = axis.dot(error);
  trial.across = (error - trial.beside * axis).norm();
  trial.turn = rotationAngle(T.inverse() * found);
  return trial;
}

}  // namespace planecloud

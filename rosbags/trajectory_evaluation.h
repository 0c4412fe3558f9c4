// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "planecloud_slam/rosbags/recording.h"

namespace planecloud {

/// Ground truth is not interpolated over longer gaps than this [s].
constexpr double kLongestGroundTruthGap = 0.05;

/// The pose of `trajectory` (ordered by stamp) at `stamp`: linear in translation, slerp in
/// rotation. Nothing outside of it or within a gap of more than `longest_gap` [s]; a pose stamped
/// within 10 us is taken whatever its neighbours.
[[nodiscard]] std::optional<Eigen::Isometry3d> poseAt(const Trajectory& trajectory, double stamp,
                                                      double longest_gap = kLongestGroundTruthGap);

/// What one robot did and what was estimated of it.
struct TrajectoryPair {
  Trajectory truth;
  Trajectory estimate;
};

/// A pose of the estimate with the ground truth at its stamp.
struct PosePair {
  double stamp = 0.0;                                                ///< [s]
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();  ///< ground truth
  Eigen::Isometry3d T_map_camera = Eigen::Isometry3d::Identity();    ///< estimate
};

/// The poses of the estimate that have ground truth, in the estimate's order.
[[nodiscard]] std::vector<PosePair> matchPoses(const TrajectoryPair& trajectories);

/// T_world_map: the rigid motion without scale that brings the estimated positions closest to
/// the true ones in the least-squares sense (Horn 1987, Umeyama 1991). Identity without poses.
[[nodiscard]] Eigen::Isometry3d alignPoses(const std::vector<PosePair>& poses);

/// Errors in the sense of the TUM RGB-D benchmark (Sturm et al., IROS 2012). NaN where there is
/// nothing to average.
struct TrajectoryErrors {
  std::size_t pairs = 0;        ///< poses with ground truth
  double ate_rmse = 0.0;        ///< absolute trajectory error after one alignment of all [m]
  double rpe_trans_rmse = 0.0;  ///< relative pose error over 1 s, translation [m]
  double rpe_rot_rmse = 0.0;    ///< the same, rotation [rad]
  /// Distance of the last pose from the truth when the poses of the first second are aligned (mean
  /// rotation and position), by the length of the true path; summed over the trajectories [-].
  double end_drift = 0.0;
};

/// Several trajectories share one alignment: robots of one map must agree.
[[nodiscard]] TrajectoryErrors evaluateTrajectories(
    const std::vector<TrajectoryPair>& trajectories);

/// The absolute trajectory error when every trajectory has an alignment of its own: for odometry,
/// whose frames are unrelated [m].
[[nodiscard]] double separatelyAlignedError(const std::vector<TrajectoryPair>& trajectories);

}  // namespace planecloud

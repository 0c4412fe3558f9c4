// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "planecloud_slam/frontend_node/dense_tracker_options.h"
#include "planecloud_slam/frontend_node/plane_landmarks.h"
#include "planecloud_slam/frontend_node/rgbd_pyramid.h"

namespace planecloud {

/// Points of one pyramid level of the reference, each member one array over all points.
/// A point lies at (u, v, 1) / q in the optical frame; `grey` and `q` are functions of the
/// tangents (u, v) around it, linear with the given gradients. The arrays are padded to a multiple
/// of `kLanes` with points that are never seen (q = 0).
struct ReferencePoints {
  static constexpr std::size_t kLanes = 8;

  std::vector<float> u;              ///< tangent [-]
  std::vector<float> v;              ///< tangent [-]
  std::vector<float> q;              ///< inverse depth [1/m]
  std::vector<float> grey;           ///< 0..255
  std::vector<float> grey_u;         ///< d grey / d u
  std::vector<float> grey_v;         ///< d grey / d v
  std::vector<float> q_u;            ///< d q / d u [1/m]
  std::vector<float> q_v;            ///< d q / d v [1/m]
  std::vector<std::uint16_t> block;  ///< image block of the point, for correlated errors
  std::size_t count = 0;             ///< without padding
  int blocks = 0;                    ///< number of image blocks

  [[nodiscard]] std::size_t paddedCount() const { return u.size(); }
};

/// An image of the same place taken a little earlier.
struct EarlierImage {
  const RgbdPyramid* pyramid = nullptr;
  Eigen::Isometry3d T_earlier_this = Eigen::Isometry3d::Identity();
};

/// The keyframe as tracking sees it: built once, compared with many frames.
class TrackingReference {
 public:
  /// Chooses the pixels that inform: the strongest gradients, and a sparse grid of all others for
  /// their depth. Pixels next to a depth edge are left out, unless they lie on its near side, and
  /// what has moved into the view: points at places that one of the `earlier` images saw through.
  /// Depth is that of the pixels around a point, or of the plane among `planes`, when given, that
  /// agrees with it.
  TrackingReference(const RgbdPyramid& pyramid, const DenseTrackerOptions& options,
                    const std::vector<EarlierImage>& earlier = {},
                    const PlaneLandmarks* planes = nullptr);

  /// Finest first.
  [[nodiscard]] const std::vector<ReferencePoints>& levels() const { return levels_; }

 private:
  std::vector<ReferencePoints> levels_;
};

}  // namespace planecloud

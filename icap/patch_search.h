// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace planecloud {

/// Patches column by column, padded with far ones to a whole number of vectors.
struct PatchColumns {
  static constexpr std::size_t kPadding = 16;  ///< of floats: the longest vectors there are

  std::size_t size = 0;                                   ///< padding included
  std::vector<float> centroid_x, centroid_y, centroid_z;  ///< [m]
  std::vector<float> normal_x, normal_y, normal_z;        ///< unit
  std::vector<float> radius;                              ///< [m]

  void add(const Eigen::Vector3d& centroid, const Eigen::Vector3d& normal, double patch_radius);
  /// Call it once after the last patch.
  void pad();
};

/// A patch looking for its partner.
struct PatchQuery {
  Eigen::Vector3f centroid = Eigen::Vector3f::Zero();  ///< [m]
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();    ///< unit
  float radius = 0.0F;                                 ///< [m]
  float max_squared_distance = 0.0F;   ///< of plane distance and in-plane gap together [m^2]
  float min_cosine = 0.0F;             ///< of the angle between normals
  float squared_normal_length = 0.0F;  ///< what makes |dn|^2 a squared length [m^2]
};

/// Position of the patch within the gates that costs least, -1 when there is none; the first of
/// equals. Cost: (distance of the query's centroid to the patch's plane)^2 + (in-plane gap beyond
/// both radii)^2 + (normal_length |dn|)^2. Exhaustive: over a thousand patches a vectorised scan is
/// several times faster than a k-d tree, which cannot know extents either. Vector instructions
/// chosen at run time where Highway is there.
[[nodiscard]] int nearestPatch(const PatchColumns& patches, const PatchQuery& query);

/// The same without vector instructions: the reference of the tests.
[[nodiscard]] int nearestPatchScalar(const PatchColumns& patches, const PatchQuery& query);

}  // namespace planecloud

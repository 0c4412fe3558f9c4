// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "planecloud_slam/icap/patch_search.h"
#include "planecloud_slam/plane_fit/camera.h"
#include "planecloud_slam/plane_fit/image_view.h"

namespace planecloud {

/// The tiles of a plane cloud as its camera sees them, laid out for many look-ups at once.
struct TileView {
  static constexpr int kCellShift = 2;  ///< cells of `cells` are 2^kCellShift pixels a side

  CameraIntrinsics camera;
  bool distorted = false;     ///< the camera has lens distortion
  Image<std::int32_t> cells;  ///< index of the tile seen through a cell's centre, -1: none
  /// Plane `n . x + d = 0` of each tile, n unit, d [m]; one more at the end, which is never looked
  /// up, so that they are never empty.
  std::vector<float> normal_x, normal_y, normal_z, d;

  void add(const Eigen::Vector3d& normal, double tile_d);

  /// Index of the tile seen through a pixel of the image, -1: none.
  [[nodiscard]] std::int32_t tileAt(int x, int y) const {
    return cells(x >> kCellShift, y >> kCellShift);
  }
};

/// Patches on their way into a view: how they move and what of them takes part.
struct MovedPatches {
  const PatchColumns& patches;
  std::size_t count = 0;  ///< the first ones, at most those there are
  Eigen::Matrix3f R_view_patch = Eigen::Matrix3f::Identity();
  Eigen::Vector3f t_view_patch = Eigen::Vector3f::Zero();  ///< [m]

  MovedPatches(const PatchColumns& moved, std::size_t most, const Eigen::Isometry3d& T_view_patch)
      : patches(moved),
        count(most),
        R_view_patch(T_view_patch.linear().cast<float>()),
        t_view_patch(T_view_patch.translation().cast<float>()) {}
};

/// How far a tile may be from a patch that falls upon it.
struct ViewGates {
  float distance = 0.0F;               ///< of the patch's centroid to the tile's plane [m]
  float min_cosine = 0.0F;             ///< between the normals
  float squared_normal_length = 0.0F;  ///< what makes |dn|^2 a squared length [m^2]
};

/// For each patch the tile it falls upon, or one close by in the image when that costs less; -1
/// where none is within the gates or the patch turns its back. Cost: (distance to the plane)^2 +
/// (way to the neighbour asked)^2 + (normal_length |dn|)^2. Vector instructions chosen at run time
/// where Highway is there; cameras with lens distortion are looked up without.
[[nodiscard]] std::vector<std::int32_t> bestTiles(const TileView& view, const MovedPatches& moved,
                                                  const ViewGates& gates);

/// What a view has where patches fall; one entry a patch.
struct SeenTiles {
  static constexpr std::int32_t kNoTile = -1;
  static constexpr std::int32_t kNotInView = -2;  ///< outside the image or turning its back

  std::vector<std::int32_t> tiles;  ///< index, kNoTile or kNotInView
  std::vector<float> depth;         ///< of the patch in the view [m]
  std::vector<float> seen_depth;    ///< where the patch's ray meets the tile's plane [m]
  std::vector<float> cosine;        ///< between the normals of patch and tile

  explicit SeenTiles(std::size_t count);
};

[[nodiscard]] SeenTiles lookUpTiles(const TileView& view, const MovedPatches& moved);

/// The same without vector instructions: the reference of the tests.
[[nodiscard]] std::vector<std::int32_t> bestTilesScalar(const TileView& view,
                                                        const MovedPatches& moved,
                                                        const ViewGates& gates);
[[nodiscard]] SeenTiles lookUpTilesScalar(const TileView& view, const MovedPatches& moved);

/// What both searches of a view share. Pixels and metres.
namespace view_search {
constexpr float kNearestDepth = 0.1F;    // of a patch that looks for a tile [m]
constexpr float kShortestStride = 4.0F;  // to the neighbours asked, cf. the view's cells [px]
constexpr float kLongestStride = 32.0F;  // [px]
constexpr float kStrideOfGate = 0.5F;    // the stride as a share of the gate
constexpr float kNoCost = 1e9F;
/// The patch's own place and its four neighbours, in strides.
constexpr int kPlaces = 5;
constexpr float kPlaceX[kPlaces] = {0.0F, 1.0F, -1.0F, 0.0F, 0.0F};
constexpr float kPlaceY[kPlaces] = {0.0F, 0.0F, 0.0F, 1.0F, -1.0F};
}  // namespace view_search

}  // namespace planecloud

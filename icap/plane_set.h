// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "planecloud_slam/icap/icap_options.h"
#include "planecloud_slam/icap/patch_search.h"
#include "planecloud_slam/icap/view_search.h"
#include "planecloud_slam/plane_fit/camera.h"
#include "planecloud_slam/plane_fit/image_view.h"
#include "planecloud_slam/plane_fit/plane_cloud.h"

namespace planecloud {

/// A tile, or a piece of one, as alignment wants it. All in the keyframe's optical frame.
struct PlanePatch {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< unit, pointing at the camera
  double d = 0.0;                                    ///< `normal . x + d = 0`, d > 0 [m]
  Eigen::Vector3d centroid =
      Eigen::Vector3d::Zero();  ///< where the rectangle's centre ray hits [m]
  double radius = 0.0;          ///< of the disc of the same area on the plane [m]
  double area = 0.0;            ///< of the rectangle's image on the plane [m^2]
  double distance_sigma = 0.0;  ///< expected error of the plane at the centroid [m]
  double normal_sigma = 0.0;    ///< expected error of the normal, each direction [rad]
  TileRect rect;                ///< pixels it was seen through
};

/// A plane cloud prepared for alignment: its tiles cut to two piece sizes, of the finer a fair
/// sample (PlaneSetOptions), and a map from pixels to tiles. Immutable and cheap to copy (copies
/// share everything); may be read from several threads.
class PlaneSet {
 public:
  /// Pieces of at most `coarse_tile`, of at most `fine_tile` pixels a side, or whole tiles.
  enum class Level { kCoarse = 0, kFine = 1, kWhole = 2 };

  /// The empty set: aligns with nothing.
  PlaneSet();

  /// Tiles that are out of range, seen at a grazing angle or smaller than `min_tile` are left out
  /// (PlaneSetOptions). Throws std::invalid_argument when `options` or the camera fail their check
  /// or a tile lies outside the image.
  explicit PlaneSet(const PlaneCloud& cloud, const PlaneSetOptions& options = PlaneSetOptions());

  [[nodiscard]] const CameraIntrinsics& camera() const;
  /// In an order that does not depend on the order of the tiles, spread over the image: the first
  /// n patches are a fair sample of all.
  [[nodiscard]] const std::vector<PlanePatch>& patches(Level level) const;
  [[nodiscard]] bool empty() const { return patches(Level::kWhole).empty(); }

  /// `patches(Level::kCoarse)` laid out for nearestPatch, in their order.
  [[nodiscard]] const PatchColumns& coarseColumns() const;

  /// `patches(Level::kFine)` laid out to be looked up in another set's view, in their order.
  [[nodiscard]] const PatchColumns& fineColumns() const;

  /// `patches(Level::kWhole)` as the camera sees them, in their order.
  [[nodiscard]] const TileView& view() const;

 private:
  struct Contents;
  std::shared_ptr<const Contents> contents_;
};

}  // namespace planecloud

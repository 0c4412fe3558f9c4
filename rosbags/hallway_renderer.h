// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <vector>

#include "planecloud_slam/plane_fit/camera.h"
#include "planecloud_slam/plane_fit/image_view.h"
#include "planecloud_slam/rosbags/hallway_shading.h"
#include "planecloud_slam/rosbags/hallway_world.h"
#include "planecloud_slam/rosbags/placed_solid.h"

namespace planecloud {

/// What an ideal camera sees: no noise, no limit of range.
struct RenderedView {
  Image<Eigen::Array3f> color;  ///< red, green, blue, 0..255, edges smoothed
  Image<float> depth;           ///< along the optical axis through the pixel's centre [m]
  /// Cosine between the ray and the surface's normal, (0, 1]; 0: the surface (glass, a lamp) sends
  /// no structured light back.
  Image<float> incidence;
};

/// Casts one ray per pixel into a HallwayWorld, four where surfaces meet. Square tiles of pixels
/// share the list of solids they can hit, ordered by distance. Rows of tiles are shared out to
/// OpenCV's threads; the result does not depend on their number.
class HallwayRenderer {
 public:
  /// Throws std::invalid_argument for a camera with lens distortion.
  HallwayRenderer(std::shared_ptr<const HallwayWorld> world, const CameraIntrinsics& camera);

  /// `T_world_camera` is the pose of the optical frame, within the world's rooms.
  [[nodiscard]] RenderedView render(const Eigen::Isometry3d& T_world_camera);

 private:
  void place(const Eigen::Isometry3d& T_world_camera);
  void castTileRow(int tile_row, RenderedView& view);
  void enterRow(const RayRow& rays, int first_x, int y, RenderedView& view);
  void smoothEdges(int tile_row, RenderedView& view) const;
  [[nodiscard]] bool isEdge(int x, int y) const;
  [[nodiscard]] Eigen::Array3f edgeColor(int x, int y) const;
  [[nodiscard]] float tangentY(float y) const {
    return (y - static_cast<float>(camera_.cy)) * pitch_.y;
  }
  [[nodiscard]] const std::vector<int>& candidates(int tile_x, int tile_row) const {
    return candidates_[static_cast<std::size_t>(tile_row * tile_columns_ + tile_x)];
  }

  std::shared_ptr<const HallwayWorld> world_;
  CameraIntrinsics camera_;
  PixelPitch pitch_;
  int tile_columns_ = 0;
  int tile_rows_ = 0;
  std::vector<float> tangents_x_;             ///< of the pixel columns
  std::vector<PlacedSolid> placed_;           ///< in front of the camera, nearest first
  std::vector<std::vector<int>> candidates_;  ///< per tile: indices into placed_, nearest first
  Image<std::int32_t> surfaces_;              ///< per pixel: 8 * index into placed_ + face; -1 none
};

}  // namespace planecloud

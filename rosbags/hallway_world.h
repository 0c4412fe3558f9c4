// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "planecloud_slam/rosbags/hallway_texture.h"

namespace planecloud {

/// What a surface looks like. Its colour is `tint * (1 + contrast * (texel - 128) / 128)` for a
/// modulation, and the texel itself times `tint` / 255 for a picture; both times the light.
struct Material {
  enum class Kind : std::uint8_t {
    kModulated,  ///< grey modulation of a tint, repeats every `metres`
    kPicture,    ///< colour texture stretched once over each face
    kLamp,       ///< shines by itself: the tint, no shading
    kGlass,      ///< picture that shines by itself and gives the depth sensor no answer
  };
  Kind kind = Kind::kModulated;
  Eigen::Array3f tint = Eigen::Array3f::Constant(180.0F);  ///< [0, 255]
  float contrast = 0.1F;                                   ///< of the texture [-]
  float blotches = 0.0F;  ///< deviation of slow changes over metres, relative [-]
  int texture = 0;        ///< index into HallwayWorld::modulations() or pictures()
  float metres = 1.5F;    ///< side of the texture on the surface [m]
  bool wall = false;      ///< painted wall, for the share of low contrast
};

/// A box turned about the vertical, or an upright cylinder (half.x() = half.y() = radius).
struct Solid {
  enum class Shape : std::uint8_t { kBox, kCylinder };
  Shape shape = Shape::kBox;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< [m], world, z up
  Eigen::Vector3d half = Eigen::Vector3d::Zero();    ///< half extents in its own axes [m]
  double yaw = 0.0;                                  ///< [rad]
  int material = 0;                                  ///< index into HallwayWorld::materials()
};

/// The built-in world: a hallway of 15 m x 2.4 m that is one side of a loop around a block, with
/// rooms, doors, cabinets, pillars, boxes and posters. z is up, the floor is z = 0; the hallway is
/// x in [0, 15], y in [0, 2.4]. The walls are the same for every seed; the seed chooses textures,
/// colours, which furniture stands where, and what hangs on the walls. Immutable.
class HallwayWorld {
 public:
  explicit HallwayWorld(std::uint64_t seed);

  [[nodiscard]] const std::vector<Solid>& solids() const { return solids_; }
  [[nodiscard]] const std::vector<Material>& materials() const { return materials_; }
  /// Grey textures around 128.
  [[nodiscard]] const std::vector<MipTexture<std::uint8_t>>& modulations() const {
    return modulations_;
  }
  [[nodiscard]] const std::vector<MipTexture<Rgb8>>& pictures() const { return pictures_; }
  /// Slow brightness changes that every material mixes in by its `blotches`.
  [[nodiscard]] const MipTexture<std::uint8_t>& blotches() const { return modulations_.front(); }
  /// Brightness of the ceiling lamps at (x, y) [m], about 0.75 to 1.1: pools of light that change
  /// over metres, the same from every direction.
  [[nodiscard]] float light(float x, float y) const;

  /// Horizontal distance [m] from (x, y) to the nearest solid that reaches into heights 0 < z <
  /// `height` [m]; 0 inside one.
  [[nodiscard]] double clearance(double x, double y, double height) const;

 private:
  void bakeLight(const std::vector<Eigen::Vector2d>& lamps);

  std::vector<Solid> solids_;
  std::vector<Material> materials_;
  std::vector<MipTexture<std::uint8_t>> modulations_;
  std::vector<MipTexture<Rgb8>> pictures_;
  Image<float> light_;
};

}  // namespace planecloud

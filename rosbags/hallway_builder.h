// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <utility>
#include <vector>

#include "planecloud_slam/rosbags/hallway_world.h"
#include "planecloud_slam/rosbags/seeded_random.h"

namespace planecloud {

/// Indices of the materials that walls, doors and furniture share.
struct HallwayPalette {
  std::vector<int> walls;
  std::vector<int> furniture;
  std::vector<int> door_leaves;
  int floor = 0;
  int ceiling = 0;
  int lamp = 0;
  int skirting = 0;
  int door_frame = 0;
  int metal = 0;
  int cardboard = 0;
  int red = 0;
};

/// A free stretch of a wall's surface that furniture may stand or hang at.
struct WallFace {
  Eigen::Vector2d start = Eigen::Vector2d::Zero();       ///< [m]
  Eigen::Vector2d direction = Eigen::Vector2d::UnitX();  ///< unit, along the wall
  Eigen::Vector2d normal = Eigen::Vector2d::UnitY();     ///< unit, into the free space
  double length = 0.0;                                   ///< [m]
};

/// Collects the parts of a HallwayWorld while it is being built.
class HallwayBuilder {
 public:
  explicit HallwayBuilder(std::uint64_t seed);

  /// An axis-aligned box between two corners [m].
  void addBox(const Eigen::Vector3d& low, const Eigen::Vector3d& high, int material);
  /// A box or cylinder standing `depth / 2` in front of a wall face: `along` is its centre's place
  /// on the face, `size` = (along the wall, away from it, height), `bottom` its lower end [m].
  void addAtWall(const WallFace& face, double along, const Eigen::Vector3d& size, double bottom,
                 int material, Solid::Shape shape = Solid::Shape::kBox);
  void addSolid(const Solid& solid) { solids_.push_back(solid); }
  /// A material with a picture of its own.
  [[nodiscard]] int addPicture(MipTexture<Rgb8> picture, Material::Kind kind, float brightness);
  void addFace(const WallFace& face) { faces_.push_back(face); }

  [[nodiscard]] SeededRandom& random() { return random_; }
  [[nodiscard]] const HallwayPalette& palette() const { return palette_; }
  [[nodiscard]] const std::vector<WallFace>& faces() const { return faces_; }
  [[nodiscard]] std::vector<Solid>&& takeSolids() { return std::move(solids_); }
  [[nodiscard]] std::vector<Material>&& takeMaterials() { return std::move(materials_); }
  [[nodiscard]] auto&& takeModulations() { return std::move(modulations_); }
  [[nodiscard]] auto&& takePictures() { return std::move(pictures_); }

 private:
  [[nodiscard]] int addModulated(int texture, const Eigen::Array3f& tint, float contrast,
                                 float metres);
  void mixPalette(std::uint64_t seed);

  SeededRandom random_;
  HallwayPalette palette_;
  std::vector<Solid> solids_;
  std::vector<Material> materials_;
  std::vector<MipTexture<std::uint8_t>> modulations_;
  std::vector<MipTexture<Rgb8>> pictures_;
  std::vector<WallFace> faces_;
};

/// Free height under the ceiling [m].
constexpr double kCeilingHeight = 2.6;

/// Floor, ceiling, walls with their doors and windows, skirting boards; leaves the hallways' wall
/// faces in the builder. Returns the places of the ceiling lamps [m].
[[nodiscard]] std::vector<Eigen::Vector2d> buildWalls(HallwayBuilder& builder);

/// Posters, notice boards, cabinets, boxes, bins, benches along the faces, pillars, and the
/// furniture of the rooms. Keeps a lane of 0.65 m to each side of the hallways' middle free.
void furnish(HallwayBuilder& builder);

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "planecloud_slam/rosbags/hallway_builder.h"
#include "planecloud_slam/rosbags/hallway_surfaces.h"

namespace planecloud {
namespace {

enum class OpeningKind { kClosedDoor, kOpenDoor, kPassage, kWindow };

struct Opening {
  double at = 0.0;  ///< its middle along the wall [m]
  OpeningKind kind = OpeningKind::kClosedDoor;
  double width = 0.92;  ///< [m]
};

/// A straight wall; its sides are called low and high by their coordinate.
struct Wall {
  bool along_x = true;
  double low = 0.0;   ///< across [m]
  double high = 0.0;  ///< across [m]
  double from = 0.0;  ///< along [m]
  double to = 0.0;    ///< along [m]
  bool low_is_hallway = false;
  bool high_is_hallway = false;
  int paint = 0;
  std::vector<Opening> openings;  ///< ordered
};

constexpr double kDoorHeight = 2.06;  // [m]
constexpr double kSillHeight = 0.9;   // [m]
constexpr double kSkirtingHeight = 0.09;
constexpr double kSkirtingDepth = 0.012;
constexpr double kFaceMargin = 0.5;     // of furniture from corners [m]
constexpr double kOpeningMargin = 0.2;  // of furniture from openings [m]

std::vector<Wall> floorPlan() {
  constexpr auto kClosed = OpeningKind::kClosedDoor;
  constexpr auto kOpen = OpeningKind::kOpenDoor;
  constexpr auto kWindow = OpeningKind::kWindow;
  const Opening lab_door{6.0, OpeningKind::kPassage, 1.2};
  return {
      // Hallway of 15 m x 2.4 m, x in [0, 15], y in [0, 2.4].
      {true,
       2.4,
       2.52,
       -0.12,
       15.12,
       true,
       false,
       0,
       {{2.3, kClosed}, lab_door, {9.4, kClosed}, {11.3, kClosed}, {13.7, kClosed}}},
      {true, -0.12, 0.0, 12.0, 15.12, false, true, 0, {{13.6, kClosed}}},
      {false, 15.0, 15.12, 0.0, 2.4, true, false, 1, {{1.2, kWindow, 1.5}}},
      {false, -0.12, 0.0, -5.52, 2.4, false, true, 1, {{-3.1, kClosed}, {1.2, kWindow, 1.3}}},
      // The block in the middle, x in [2.2, 9.8], y in [-3.2, 0], with two rooms.
      {true, -0.12, 0.0, 2.2, 9.8, false, true, 2, {{3.6, kOpen}, {8.2, kClosed}}},
      {true, -3.2, -3.08, 2.2, 9.8, true, false, 2, {{4.7, kClosed}, {7.4, kOpen}}},
      {false, 2.2, 2.32, -3.08, -0.12, true, false, 1, {}},
      {false, 9.68, 9.8, -3.08, -0.12, false, true, 2, {{-1.7, kClosed}}},
      {false, 5.95, 6.07, -3.08, -0.12, false, false, 0, {}},
      // The hallways in the south, y in [-5.4, -3.2], and in the east, x in [9.8, 12].
      {true,
       -5.52,
       -5.4,
       0.0,
       12.12,
       false,
       true,
       0,
       {{2.7, kClosed}, {5.9, kOpen, 1.0}, {8.3, kClosed}}},
      {false, 12.0, 12.12, -5.4, -0.12, true, false, 1, {{-2.9, kClosed}}},
      // The laboratory in the north and the office in the south.
      {false, 3.38, 3.5, 2.52, 6.52, false, false, 1, {}},
      {false, 8.5, 8.62, 2.52, 6.52, false, false, 1, {}},
      {true, 6.4, 6.52, 3.5, 8.5, false, false, 2, {{4.8, kWindow, 1.4}, {7.2, kWindow, 1.4}}},
      {false, 4.38, 4.5, -8.52, -5.52, false, false, 2, {}},
      {false, 7.5, 7.62, -8.52, -5.52, false, false, 2, {}},
      {true, -8.52, -8.4, 4.5, 7.5, false, false, 1, {{6.0, kWindow, 1.6}}},
  };
}

/// Builds one wall; `span` maps (along, across, z) ranges to boxes of the world.
class WallMaker {
 public:
  WallMaker(HallwayBuilder& builder, const Wall& wall) : builder_(builder), wall_(wall) {}

  void make() {
    double from = wall_.from;
    for (const Opening& opening : wall_.openings) {
      const double start = opening.at - 0.5 * opening.width;
      piece(from, start);
      from = start + opening.width;
      fill(opening, start, from);
    }
    piece(from, wall_.to);
  }

 private:
  void span(const Eigen::Vector2d& along, const Eigen::Vector2d& across, const Eigen::Vector2d& z,
            int material) {
    const auto corner = [&](int end) {
      return wall_.along_x ? Eigen::Vector3d(along[end], across[end], z[end])
                           : Eigen::Vector3d(across[end], along[end], z[end]);
    };
    builder_.addBox(corner(0), corner(1), material);
  }

  [[nodiscard]] int paint() const {
    return builder_.palette().walls[static_cast<std::size_t>(wall_.paint)];
  }

  void piece(double from, double to) {
    span({from, to}, {wall_.low, wall_.high}, {0.0, kCeilingHeight}, paint());
    skirting(from, to);
    if (wall_.high_is_hallway) face(from, to, wall_.high, 1.0);
    if (wall_.low_is_hallway) face(from, to, wall_.low, -1.0);
  }

  void skirting(double from, double to) {
    span({from, to}, {wall_.low - kSkirtingDepth, wall_.high + kSkirtingDepth},
         {0.0, kSkirtingHeight}, builder_.palette().skirting);
  }

  void face(double from, double to, double across, double normal) {
    const double start = from + (from == wall_.from ? kFaceMargin : kOpeningMargin);
    const double end = to - (to == wall_.to ? kFaceMargin : kOpeningMargin);
    if (end - start < 0.3) return;
    const Eigen::Vector2d direction =
        wall_.along_x ? Eigen::Vector2d::UnitX() : Eigen::Vector2d::UnitY();
    const Eigen::Vector2d out = wall_.along_x ? Eigen::Vector2d::UnitY() : Eigen::Vector2d::UnitX();
    builder_.addFace({start * direction + across * out, direction, normal * out, end - start});
  }

  void fill(const Opening& opening, double start, double end) {
    const Eigen::Vector2d across(wall_.low, wall_.high);
    const bool window = opening.kind == OpeningKind::kWindow;
    span({start, end}, across, {kDoorHeight, kCeilingHeight}, paint());
    if (window) {
      span({start, end}, across, {0.0, kSillHeight}, paint());
      skirting(start, end);
    }
    frame(start, end, window ? kSillHeight : 0.0);
    if (window) glaze(start, end);
    if (opening.kind == OpeningKind::kClosedDoor) closeDoor(start, end);
    if (opening.kind == OpeningKind::kOpenDoor) openDoor(start, end);
  }

  void frame(double start, double end, double bottom) {
    constexpr double kWidth = 0.06;
    const Eigen::Vector2d across(wall_.low - 0.02, wall_.high + 0.02);
    const int material = builder_.palette().door_frame;
    span({start - kWidth, start}, across, {bottom, kDoorHeight}, material);
    span({end, end + kWidth}, across, {bottom, kDoorHeight}, material);
    span({start - kWidth, end + kWidth}, across, {kDoorHeight, kDoorHeight + kWidth}, material);
    if (bottom > 0.0) {
      span({start - kWidth, end + kWidth}, across, {bottom - kWidth, bottom}, material);
    }
  }

  void glaze(double start, double end) {
    const double middle = 0.5 * (wall_.low + wall_.high);
    const int glass = builder_.addPicture(makeWindowTexture(builder_.random().bits()),
                                          Material::Kind::kGlass, 1.0F);
    span({start, end}, {middle - 0.01, middle + 0.01}, {kSillHeight, kDoorHeight}, glass);
    const double bar = 0.5 * (start + end);
    span({bar - 0.03, bar + 0.03}, {middle - 0.03, middle + 0.03}, {kSillHeight, kDoorHeight},
         builder_.palette().door_frame);
  }

  void closeDoor(double start, double end) {
    const HallwayPalette& palette = builder_.palette();
    const double middle = 0.5 * (wall_.low + wall_.high);
    const int leaf = palette.door_leaves[static_cast<std::size_t>(builder_.random().integer(0, 2))];
    span({start, end}, {middle - 0.025, middle + 0.025}, {0.0, kDoorHeight}, leaf);
    span({end - 0.2, end - 0.08}, {middle - 0.07, middle + 0.07}, {1.02, 1.05}, palette.metal);
    sign(end + 0.16);
  }

  /// The leaf stands open into the room, hinged at `start`.
  void openDoor(double start, double end) {
    const double width = end - start;
    const double angle = builder_.random().uniform(1.3, 1.75);
    const double away = wall_.low_is_hallway ? 1.0 : -1.0;
    const double hinge = wall_.low_is_hallway ? wall_.high : wall_.low;
    const Eigen::Vector2d leaf(0.5 * width * std::cos(angle), away * 0.5 * width * std::sin(angle));
    Solid solid;
    const Eigen::Vector2d centre(start + leaf.x(), hinge + leaf.y() + away * 0.03);
    solid.centre = {wall_.along_x ? centre.x() : centre.y(),
                    wall_.along_x ? centre.y() : centre.x(), 0.5 * kDoorHeight};
    solid.half = {0.5 * width, 0.022, 0.5 * kDoorHeight};
    const double yaw = std::atan2(leaf.y(), leaf.x());
    solid.yaw = wall_.along_x ? yaw : 0.5 * M_PI - yaw;
    solid.material = builder_.palette().door_leaves[0];
    builder_.addSolid(solid);
    sign(end + 0.16);
  }

  /// The room's number plate, beside the door on the hallways' side.
  void sign(double at) {
    const int plate = builder_.addPicture(makePosterTexture(builder_.random().bits()),
                                          Material::Kind::kPicture, 0.9F);
    const double outside = wall_.low_is_hallway ? wall_.low - 0.008 : wall_.high + 0.008;
    const double wall_side = wall_.low_is_hallway ? wall_.low : wall_.high;
    span({at - 0.08, at + 0.08}, {std::min(outside, wall_side), std::max(outside, wall_side)},
         {1.4, 1.6}, plate);
  }

  HallwayBuilder& builder_;
  const Wall& wall_;
};

std::vector<Eigen::Vector2d> lampPlaces() {
  std::vector<Eigen::Vector2d> places;
  for (double x = 1.1; x < 15.0; x += 2.55) places.emplace_back(x, 1.2);
  for (double x = 1.1; x < 12.0; x += 2.45) places.emplace_back(x, -4.3);
  places.emplace_back(1.1, -1.6);
  places.emplace_back(10.9, -1.5);
  places.emplace_back(4.6, 4.4);
  places.emplace_back(7.2, 4.4);
  places.emplace_back(4.1, -1.6);
  places.emplace_back(7.9, -1.6);
  places.emplace_back(6.0, -6.9);
  return places;
}

}  // namespace

std::vector<Eigen::Vector2d> buildWalls(HallwayBuilder& builder) {
  const HallwayPalette& palette = builder.palette();
  builder.addBox({-1.0, -9.5, -0.1}, {16.0, 7.5, 0.0}, palette.floor);
  builder.addBox({-1.0, -9.5, kCeilingHeight}, {16.0, 7.5, kCeilingHeight + 0.1}, palette.ceiling);
  for (const Wall& wall : floorPlan()) WallMaker(builder, wall).make();
  const std::vector<Eigen::Vector2d> lamps = lampPlaces();
  for (const Eigen::Vector2d& lamp : lamps) {
    builder.addBox({lamp.x() - 0.6, lamp.y() - 0.15, kCeilingHeight - 0.06},
                   {lamp.x() + 0.6, lamp.y() + 0.15, kCeilingHeight}, palette.lamp);
  }
  return lamps;
}

}  // namespace planecloud

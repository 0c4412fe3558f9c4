// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "planecloud_slam/rosbags/hallway_builder.h"
#include "planecloud_slam/rosbags/hallway_surfaces.h"

namespace planecloud {
namespace {

constexpr double kMaxDepth = 0.42;  // of what stands in a hallway [m]

int oneOf(const std::vector<int>& materials, SeededRandom& random) {
  return materials[static_cast<std::size_t>(
      random.integer(0, static_cast<int>(materials.size()) - 1))];
}

int newPoster(HallwayBuilder& builder) {
  return builder.addPicture(makePosterTexture(builder.random().bits()), Material::Kind::kPicture,
                            0.92F);
}

/// Each of these places one thing at the `from` end of a face and returns the length it took.
double hangPoster(HallwayBuilder& builder, const WallFace& face, double from) {
  const double width = builder.random().uniform(0.5, 0.95);
  const double height = builder.random().uniform(0.55, 1.1);
  const double bottom = builder.random().uniform(0.65, 1.0);
  builder.addAtWall(face, from + 0.5 * width, {width, 0.012, height}, bottom, newPoster(builder));
  return width;
}

double hangNoticeBoard(HallwayBuilder& builder, const WallFace& face, double from) {
  SeededRandom& random = builder.random();
  const double width = random.uniform(1.1, 1.6);
  builder.addAtWall(face, from + 0.5 * width, {width, 0.025, 0.95}, 0.8,
                    builder.palette().cardboard);
  for (double x = 0.08; x < width - 0.35; x += 0.42) {
    const double height = random.uniform(0.3, 0.6);
    builder.addAtWall(face, from + x + 0.17, {random.uniform(0.25, 0.36), 0.03, height},
                      random.uniform(0.85, 1.65 - height), newPoster(builder));
  }
  return width;
}

double placeCabinet(HallwayBuilder& builder, const WallFace& face, double from) {
  SeededRandom& random = builder.random();
  const double width = random.uniform(0.6, 1.0);
  const double depth = random.uniform(0.3, kMaxDepth - 0.02);
  const double height = random.uniform(0.75, 1.5);
  const int material = oneOf(builder.palette().furniture, random);
  builder.addAtWall(face, from + 0.5 * width, {width, depth, height}, 0.0, material);
  const int doors = random.integer(1, 3);
  for (int i = 0; i < doors; ++i) {
    const double at = from + width * (i + 0.5) / doors;
    builder.addAtWall(face, at, {0.9 * width / doors, depth + 0.015, 0.82 * height}, 0.09 * height,
                      material);
    builder.addAtWall(face, at, {0.12, depth + 0.04, 0.02}, 0.7 * height, builder.palette().metal);
  }
  return width;
}

double stackBoxes(HallwayBuilder& builder, const WallFace& face, double from) {
  SeededRandom& random = builder.random();
  double bottom = 0.0;
  const int boxes = random.integer(1, 3);
  for (int i = 0; i < boxes; ++i) {
    Solid box;
    box.half = {random.uniform(0.12, 0.17), random.uniform(0.09, 0.14), random.uniform(0.1, 0.2)};
    const Eigen::Vector2d place = face.start + (from + 0.24) * face.direction + 0.23 * face.normal;
    box.centre = {place.x(), place.y(), bottom + box.half.z()};
    box.yaw = std::atan2(face.direction.y(), face.direction.x()) + random.uniform(-0.4, 0.4);
    box.material = builder.palette().cardboard;
    builder.addSolid(box);
    bottom += 2.0 * box.half.z();
  }
  return 0.48;
}

double placeBin(HallwayBuilder& builder, const WallFace& face, double from) {
  SeededRandom& random = builder.random();
  const double width = random.uniform(0.26, 0.36);
  builder.addAtWall(face, from + 0.5 * width, {width, width, random.uniform(0.4, 0.7)}, 0.0,
                    oneOf(builder.palette().furniture, random), Solid::Shape::kCylinder);
  return width;
}

double hangExtinguisher(HallwayBuilder& builder, const WallFace& face, double from) {
  builder.addAtWall(face, from + 0.12, {0.16, 0.16, 0.5}, 0.35, builder.palette().red,
                    Solid::Shape::kCylinder);
  builder.addAtWall(face, from + 0.12, {0.24, 0.01, 0.24}, 1.05, newPoster(builder));
  return 0.24;
}

double placeBench(HallwayBuilder& builder, const WallFace& face, double from) {
  const double width = builder.random().uniform(0.9, 1.3);
  const int wood = builder.palette().door_leaves.back();
  builder.addAtWall(face, from + 0.5 * width, {width, 0.38, 0.05}, 0.42, wood);
  for (const double leg : {0.1, width - 0.1}) {
    builder.addAtWall(face, from + leg, {0.05, 0.34, 0.42}, 0.0, builder.palette().metal);
  }
  return width;
}

double placeRadiator(HallwayBuilder& builder, const WallFace& face, double from) {
  const double width = builder.random().uniform(0.7, 1.2);
  builder.addAtWall(face, from + 0.5 * width, {width, 0.06, 0.5}, 0.12, builder.palette().metal);
  for (double rib = 0.05; rib < width; rib += 0.1) {
    builder.addAtWall(face, from + rib, {0.04, 0.09, 0.5}, 0.12, builder.palette().metal);
  }
  return width;
}

using Placer = double (*)(HallwayBuilder&, const WallFace&, double from);

/// What may stand or hang somewhere, how much room it needs at most [m], and how common it is.
struct Thing {
  Placer place;
  double longest;
  double weight;
};
constexpr Thing kThings[] = {
    {hangPoster, 0.95, 0.24}, {hangNoticeBoard, 1.6, 0.10}, {placeCabinet, 1.0, 0.20},
    {stackBoxes, 0.48, 0.16}, {placeBin, 0.36, 0.09},       {hangExtinguisher, 0.24, 0.05},
    {placeBench, 1.3, 0.08},  {placeRadiator, 1.2, 0.08},
};

/// Fills a face from its start to its end with things that fit.
void furnishFace(HallwayBuilder& builder, const WallFace& face) {
  constexpr double kSmallest = 0.5;
  double from = builder.random().uniform(0.0, 0.25);
  while (from + kSmallest < face.length) {
    double choice = builder.random().uniform(0.0, 1.0);
    for (const Thing& thing : kThings) {
      choice -= thing.weight;
      if (choice > 0.0) continue;
      if (from + thing.longest <= face.length) from += thing.place(builder, face, from);
      break;
    }
    from += builder.random().uniform(0.3, 0.95);
  }
}

/// Half-embedded round pillars and square pilasters, the same for every seed.
void raisePillars(HallwayBuilder& builder) {
  const int paint = builder.palette().walls.front();
  const auto pillar = [&](double x, double y, Solid::Shape shape) {
    Solid solid;
    solid.shape = shape;
    solid.centre = {x, y, 0.5 * kCeilingHeight};
    solid.half = {0.2, 0.2, 0.5 * kCeilingHeight};
    solid.material = paint;
    builder.addSolid(solid);
  };
  pillar(7.45, 2.4, Solid::Shape::kCylinder);
  pillar(12.45, 2.4, Solid::Shape::kCylinder);
  pillar(9.8, -3.2, Solid::Shape::kBox);
  pillar(0.0, -0.2, Solid::Shape::kCylinder);
  pillar(4.2, -5.4, Solid::Shape::kBox);
}

void placeTable(HallwayBuilder& builder, const Eigen::Vector2d& low, const Eigen::Vector2d& high) {
  const int top = oneOf(builder.palette().furniture, builder.random());
  builder.addBox({low.x(), low.y(), 0.71}, {high.x(), high.y(), 0.75}, top);
  for (const double x : {low.x() + 0.05, high.x() - 0.05}) {
    for (const double y : {low.y() + 0.05, high.y() - 0.05}) {
      builder.addBox({x - 0.025, y - 0.025, 0.0}, {x + 0.025, y + 0.025, 0.71},
                     builder.palette().metal);
    }
  }
  const double place = builder.random().uniform(low.x() + 0.2, high.x() - 0.4);
  builder.addBox({place, low.y() + 0.1, 0.75}, {place + 0.3, low.y() + 0.4, 1.05},
                 builder.palette().cardboard);
}

void furnishRooms(HallwayBuilder& builder) {
  placeTable(builder, {3.7, 5.5}, {5.0, 6.2});
  placeTable(builder, {7.1, 5.5}, {8.3, 6.2});
  placeTable(builder, {2.7, -2.9}, {4.3, -2.2});
  placeTable(builder, {7.0, -0.9}, {8.6, -0.2});
  placeTable(builder, {4.8, -8.2}, {6.4, -7.5});
  const WallFace faces[] = {
      {{3.5, 2.9}, {0, 1}, {1, 0}, 2.4},   {{8.5, 2.9}, {0, 1}, {-1, 0}, 2.4},
      {{2.5, -3.08}, {1, 0}, {0, 1}, 3.2}, {{6.3, -0.12}, {1, 0}, {0, -1}, 3.2},
      {{4.5, -8.2}, {0, 1}, {1, 0}, 2.4},  {{7.5, -8.2}, {0, 1}, {-1, 0}, 2.4},
      {{2.32, -2.8}, {0, 1}, {1, 0}, 2.4}, {{9.68, -2.8}, {0, 1}, {-1, 0}, 2.4},
      {{3.8, 6.4}, {1, 0}, {0, -1}, 1.0},  {{3.6, 2.52}, {1, 0}, {0, 1}, 1.6}};
  for (const WallFace& face : faces) furnishFace(builder, face);
}

}  // namespace

void furnish(HallwayBuilder& builder) {
  raisePillars(builder);
  for (const WallFace& face : std::vector<WallFace>(builder.faces())) furnishFace(builder, face);
  furnishRooms(builder);
}

}  // namespace planecloud

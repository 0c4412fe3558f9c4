// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/rosbags/hallway_builder.h"

#include <cmath>
#include <utility>

#include "planecloud_slam/rosbags/hallway_surfaces.h"

namespace planecloud {

HallwayBuilder::HallwayBuilder(std::uint64_t seed) : random_(hashOf(seed, 0x77)) {
  mixPalette(seed);
}

void HallwayBuilder::mixPalette(std::uint64_t seed) {
  modulations_.push_back(makeBlotchTexture(hashOf(seed, 1)));  // HallwayWorld::blotches()
  modulations_.push_back(makePaintTexture(hashOf(seed, 2)));
  modulations_.push_back(makeFloorTexture(hashOf(seed, 3)));
  modulations_.push_back(makeCeilingTexture(hashOf(seed, 4)));
  modulations_.push_back(makeWoodTexture(hashOf(seed, 5)));
  modulations_.push_back(makeCardboardTexture(hashOf(seed, 6)));
  enum { kBlotch, kPaint, kFloor, kCeiling, kWood, kCardboard };

  const Eigen::Array3f paints[] = {{196, 192, 180}, {188, 194, 196}, {200, 190, 176}};
  for (const Eigen::Array3f& paint : paints) {
    const auto shade = static_cast<float>(random_.uniform(0.96, 1.04));
    palette_.walls.push_back(addModulated(kPaint, paint * shade, 0.1F, 1.6F));
    materials_.back().wall = true;
    materials_.back().blotches = 0.05F;
  }
  const Eigen::Array3f leaves[] = {{150, 108, 70}, {118, 128, 140}, {164, 132, 92}};
  for (const Eigen::Array3f& leaf : leaves) {
    palette_.door_leaves.push_back(addModulated(kWood, leaf, 0.16F, 1.3F));
  }
  for (int i = 0; i < 5; ++i) {
    const Eigen::Array3f color(static_cast<float>(random_.uniform(60, 200)),
                               static_cast<float>(random_.uniform(60, 190)),
                               static_cast<float>(random_.uniform(60, 180)));
    palette_.furniture.push_back(addModulated(i % 2 == 0 ? kWood : kPaint, color, 0.2F, 1.1F));
  }
  palette_.floor = addModulated(kFloor, {128, 124, 116}, 0.5F, 1.8F);
  materials_.back().blotches = 0.15F;
  palette_.ceiling = addModulated(kCeiling, {206, 206, 202}, 0.3F, 1.2F);
  palette_.skirting = addModulated(kPaint, {84, 78, 74}, 0.15F, 1.0F);
  palette_.door_frame = addModulated(kPaint, {128, 124, 120}, 0.12F, 1.0F);
  palette_.metal = addModulated(kPaint, {168, 170, 174}, 0.1F, 0.8F);
  palette_.cardboard = addModulated(kCardboard, {176, 138, 96}, 0.6F, 0.9F);
  palette_.red = addModulated(kPaint, {190, 36, 30}, 0.2F, 0.5F);
  Material lamp;
  lamp.kind = Material::Kind::kLamp;
  lamp.tint = {246, 246, 240};
  materials_.push_back(lamp);
  palette_.lamp = static_cast<int>(materials_.size()) - 1;
}

int HallwayBuilder::addModulated(int texture, const Eigen::Array3f& tint, float contrast,
                                 float metres) {
  Material material;
  material.tint = tint;
  material.contrast = contrast;
  material.blotches = 0.075F;
  material.texture = texture;
  material.metres = metres;
  materials_.push_back(material);
  return static_cast<int>(materials_.size()) - 1;
}

int HallwayBuilder::addPicture(MipTexture<Rgb8> picture, Material::Kind kind, float brightness) {
  Material material;
  material.kind = kind;
  material.tint = Eigen::Array3f::Constant(255.0F * brightness);
  material.texture = static_cast<int>(pictures_.size());
  pictures_.push_back(std::move(picture));
  materials_.push_back(material);
  return static_cast<int>(materials_.size()) - 1;
}

void HallwayBuilder::addBox(const Eigen::Vector3d& low, const Eigen::Vector3d& high, int material) {
  Solid solid;
  solid.centre = 0.5 * (low + high);
  solid.half = 0.5 * (high - low).cwiseAbs();
  solid.material = material;
  solids_.push_back(solid);
}

void HallwayBuilder::addAtWall(const WallFace& face, double along, const Eigen::Vector3d& size,
                               double bottom, int material, Solid::Shape shape) {
  const Eigen::Vector2d place = face.start + along * face.direction + 0.5 * size.y() * face.normal;
  Solid solid;
  solid.shape = shape;
  solid.centre = {place.x(), place.y(), bottom + 0.5 * size.z()};
  solid.half = 0.5 * size;
  solid.yaw = std::atan2(face.direction.y(), face.direction.x());
  solid.material = material;
  solids_.push_back(solid);
}

}  // namespace planecloud

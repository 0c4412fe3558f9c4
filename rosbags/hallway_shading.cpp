// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/rosbags/hallway_shading.h"

#include <algorithm>
#include <cmath>

namespace planecloud {
namespace {

constexpr float kBlotchMetres = 9.7F;  // side of the blotch texture on a surface

/// Coordinates on a face [m] and how far one pixel to the right and down reaches on it [m].
struct SurfacePatch {
  Eigen::Vector2f place = Eigen::Vector2f::Zero();
  Eigen::Vector2f right = Eigen::Vector2f::Zero();
  Eigen::Vector2f down = Eigen::Vector2f::Zero();
};

/// How far the hit moves on the tangent plane when the ray turns by `turn`.
Eigen::Vector3f moved(const SurfaceHit& hit, const Eigen::Vector3f& turn) {
  const float facing = hit.normal.dot(hit.direction);
  const float safe = std::copysign(std::max(std::abs(facing), 0.02F), facing);
  return hit.depth * (turn - hit.direction * (hit.normal.dot(turn) / safe));
}

/// Picks the face's two axes: horizontal first, height (or y on floors) second.
Eigen::Vector2f onFace(const Eigen::Vector3f& vector, int axis) {
  if (axis == 0) return {vector.y(), vector.z()};
  if (axis == 1) return {vector.x(), vector.z()};
  return {vector.x(), vector.y()};
}

SurfacePatch patchOf(const PlacedSolid& placed, const SurfaceHit& hit, const PixelPitch& pitch) {
  const Eigen::Vector3f right = moved(hit, placed.cameraAxes().col(0) * pitch.x);
  const Eigen::Vector3f down = moved(hit, placed.cameraAxes().col(1) * pitch.y);
  const bool mantle = placed.solid().shape == Solid::Shape::kCylinder && hit.normal.z() == 0.0F;
  if (!mantle) {
    const int axis = hit.face / 2;
    return {onFace(hit.point, axis), onFace(right, axis), onFace(down, axis)};
  }
  const auto radius = static_cast<float>(placed.solid().half.x());
  const Eigen::Vector3f around(-hit.normal.y(), hit.normal.x(), 0.0F);
  return {{radius * std::atan2(hit.normal.y(), hit.normal.x()), hit.point.z()},
          {around.dot(right), right.z()},
          {around.dot(down), down.z()}};
}

TextureFootprint footprintOf(const SurfacePatch& patch, const Eigen::Array2f& texels_per_metre,
                             const Eigen::Vector2f& offset) {
  const Eigen::Vector2f right = patch.right.array() * texels_per_metre;
  const Eigen::Vector2f down = patch.down.array() * texels_per_metre;
  const bool right_longer = right.squaredNorm() > down.squaredNorm();
  TextureFootprint footprint;
  footprint.centre = (patch.place + offset).array() * texels_per_metre;
  footprint.major = right_longer ? right : down;
  // The area of the parallelogram over its long side: its width.
  const float area = std::abs(right.x() * down.y() - right.y() * down.x());
  footprint.minor = area / std::max(footprint.major.norm(), 1e-6F);
  return footprint;
}

Eigen::Array3f pictureColor(const MipTexture<Rgb8>& picture, const PlacedSolid& placed, int axis,
                            const SurfacePatch& patch) {
  const Eigen::Vector2f half = onFace(placed.half(), axis);
  const auto side = static_cast<float>(picture.side());
  // Rows of a picture run downwards, heights upwards.
  const Eigen::Array2f texels_per_metre(0.5F * side / half.x(), -0.5F * side / half.y());
  const Eigen::Vector2f corner(half.x(), -half.y());
  return picture.sample(footprintOf(patch, texels_per_metre, corner));
}

/// Relative change of a material's brightness at a place.
float modulation(const HallwayWorld& world, const Material& material, const PlacedSolid& placed,
                 const SurfacePatch& patch) {
  const Eigen::Vector2f& offset = placed.textureOffset();
  const MipTexture<std::uint8_t>& texture =
      world.modulations()[static_cast<std::size_t>(material.texture)];
  const Eigen::Array2f fine =
      Eigen::Array2f::Constant(static_cast<float>(texture.side()) / material.metres);
  const float grain = texture.sample(footprintOf(patch, fine, offset)) / 128.0F - 1.0F;
  const MipTexture<std::uint8_t>& blotches = world.blotches();
  const Eigen::Vector2f coarse =
      (patch.place + offset) * (static_cast<float>(blotches.side()) / kBlotchMetres);
  const float blotch = blotches.sampleFinest(coarse) / 128.0F - 1.0F;
  return 1.0F + material.contrast * grain + material.blotches * blotch;
}

/// Brightness by the direction a surface faces: floors bright, ceilings dark, walls between.
float facingLight(const PlacedSolid& placed, const Eigen::Vector3f& normal) {
  const Eigen::Vector2f facing = placed.toWorld(normal);
  return 0.9F + 0.04F * facing.x() - 0.06F * facing.y() + 0.08F * normal.z();
}

}  // namespace

Eigen::Array3f shade(const HallwayWorld& world, const PlacedSolid& placed, const SurfaceHit& hit,
                     const PixelPitch& pitch) {
  const Material& material = world.materials()[static_cast<std::size_t>(placed.solid().material)];
  if (material.kind == Material::Kind::kLamp) return material.tint;
  const SurfacePatch patch = patchOf(placed, hit, pitch);
  const Eigen::Vector2f place = placed.place() + placed.toWorld(hit.point);
  const float light = world.light(place.x(), place.y()) * facingLight(placed, hit.normal);
  if (material.kind == Material::Kind::kModulated) {
    return material.tint * (light * modulation(world, material, placed, patch));
  }
  const MipTexture<Rgb8>& picture = world.pictures()[static_cast<std::size_t>(material.texture)];
  const Eigen::Array3f color =
      pictureColor(picture, placed, hit.face / 2, patch) * (material.tint / 255.0F);
  return material.kind == Material::Kind::kGlass ? color : Eigen::Array3f(light * color);
}

}  // namespace planecloud

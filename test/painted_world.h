// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "planecloud_slam/plane_fit/appearance_descriptor.h"
#include "synthetic_robot.h"

namespace planecloud {

/// A world of painted rectangles and what a frontend would make of it: plane clouds and
/// descriptors, at 10 ms a view. z up.
class PaintedWorld {
 public:
  /// The six faces of a box, its edges along the axes; boxes of the same paint look alike.
  void addBox(const Eigen::Vector3d& centre, const Eigen::Vector3d& half, std::uint32_t paint) {
    SyntheticPlanes box({});
    box.addBox(centre, half);
    for (const Face& face : box.faces()) {
      faces_.push_back(face);
      paints_.push_back(paint);
    }
  }

  /// What a camera sees at `T_world_camera`: planes, and its appearance.
  struct View {
    PlaneCloud planes;
    std::vector<std::uint8_t> descriptor;
  };
  [[nodiscard]] View view(const Eigen::Isometry3d& T_world_camera, unsigned seed) const {
    const std::vector<std::size_t> near = facesNear(T_world_camera);
    std::vector<Face> faces;
    std::vector<std::uint32_t> paints;
    for (const std::size_t i : near) {
      faces.push_back(faces_[i]);
      paints.push_back(paints_[i]);
    }
    const SyntheticPlanes local(std::move(faces));
    return {local.view(T_world_camera, kNoise, seed), describe(local, paints, T_world_camera)};
  }

 private:
  static constexpr double kRange = 7.0;     // of the camera [m]
  static constexpr double kNoise = 1.5e-3;  // of a pixel's inverse depth [1/m]
  static constexpr double kTexel = 0.5;     // side of a patch of even paint [m]

  /// Faces with a part within range and before the camera.
  [[nodiscard]] std::vector<std::size_t> facesNear(const Eigen::Isometry3d& T_world_camera) const {
    const Eigen::Vector3d eye = T_world_camera.translation();
    const Eigen::Vector3d ahead = T_world_camera.linear().col(2);
    std::vector<std::size_t> near;
    for (std::size_t i = 0; i < faces_.size(); ++i) {
      const Face& face = faces_[i];
      const Eigen::Vector3d half = face.half_a.cwiseAbs() + face.half_b.cwiseAbs();
      const Eigen::Vector3d offset = (face.centre - eye).cwiseAbs() - half;
      if (offset.cwiseMax(0.0).norm() > kRange) continue;
      const double reach = std::abs(ahead.dot(face.half_a)) + std::abs(ahead.dot(face.half_b));
      if (ahead.dot(face.centre - eye) + reach > 0.0) near.push_back(i);
    }
    return near;
  }

  /// The appearance from an image of two by two pixels a cell of the descriptor.
  [[nodiscard]] static std::vector<std::uint8_t> describe(const SyntheticPlanes& local,
                                                          const std::vector<std::uint32_t>& paints,
                                                          const Eigen::Isometry3d& T_world_camera) {
    constexpr int kWidth = 40;
    constexpr int kRows = 24;
    Image<std::uint8_t> grey(kWidth, kRows, 90);
    Image<float> depth(kWidth, kRows, 0.0F);
    for (int y = 0; y < kRows; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const auto hit = local.firstHit(T_world_camera, 16.0 * x + 7.5, 20.0 * y + 9.5);
        if (hit.face < 0) continue;
        const auto face = static_cast<std::size_t>(hit.face);
        depth(x, y) = static_cast<float>(hit.depth);
        grey(x, y) = paint(local.faces()[face], paints[face], hit.point);
      }
    }
    return makeAppearanceDescriptor(grey.view(), depth.view());
  }

  /// Brightness: even over a patch, walls fainter than boxes, the same from left to right as from
  /// right to left.
  [[nodiscard]] static std::uint8_t paint(const Face& face, std::uint32_t name,
                                          const Eigen::Vector3d& point) {
    const Eigen::Vector3d offset = point - face.centre;
    const auto texel = [&](const Eigen::Vector3d& half) {
      return static_cast<std::uint32_t>(
          static_cast<int>(std::abs(offset.dot(half.normalized())) / kTexel));
    };
    std::uint32_t h = name * 0x9e3779b1U;
    const std::uint32_t whole = (h ^ (h >> 15)) * 0x85ebca6bU;
    h = (h ^ (texel(face.half_a) * 0x85ebca6bU) ^ (texel(face.half_b) * 0xc2b2ae35U)) * 0x27d4eb2fU;
    h = (h ^ (h >> 15)) * 0x85ebca6bU;
    const bool large = std::max(face.half_a.norm(), face.half_b.norm()) > 2.0;
    const double base = large ? 150.0 : 60.0 + 120.0 * ((whole >> 16) & 255U) / 255.0;
    const double contrast = large ? 24.0 : 50.0;
    return static_cast<std::uint8_t>(base + contrast * (((h >> 13) & 255U) / 255.0 - 0.5));
  }

  std::vector<Face> faces_;
  std::vector<std::uint32_t> paints_;  ///< of the faces
};

/// A robot that tells in keyframes, as they travel, what it sees of a PaintedWorld.
class PaintedRobot : public SyntheticOdometry {
 public:
  PaintedRobot(const PaintedWorld& world, const std::string& name, unsigned seed)
      : SyntheticOdometry(name, seed), world_(world) {
    history = 2;
  }

  Keyframe see(const Eigen::Isometry3d& T_world_camera) {
    Keyframe keyframe = moveTo(T_world_camera);
    PaintedWorld::View view = world_.view(truth.back(), draw());
    keyframe.planes = encode(view.planes, CodecOptions());
    keyframe.descriptor = std::move(view.descriptor);
    return keyframe;
  }

 private:
  const PaintedWorld& world_;
};

}  // namespace planecloud

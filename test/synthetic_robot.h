// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "planecloud_slam/plane_fit/keyframe.h"
#include "planecloud_slam/plane_fit/plane_cloud_codec.h"
#include "synthetic_planes.h"

namespace planecloud {

/// A hall of 11 m x 8 m around a block, furnished so that no two places are alike; z up.
inline SyntheticPlanes makeHall() {
  SyntheticPlanes world({});
  world.addBox({0.0, 0.0, 1.3}, {5.5, 4.0, 1.3});
  world.addBox({0.0, 0.0, 1.3}, {2.9, 1.5, 1.3});
  world.addBox({-5.2, -1.0, 0.6}, {0.3, 0.7, 0.6});
  world.addBox({-3.6, -3.8, 1.0}, {0.5, 0.2, 1.0});
  world.addBox({0.9, -3.7, 0.4}, {0.7, 0.3, 0.4});
  world.addBox({3.2, -3.75, 0.9}, {0.2, 0.25, 0.9});
  world.addBox({5.1, -2.1, 0.5}, {0.4, 0.3, 0.5});
  world.addBox({5.3, 1.4, 1.0}, {0.2, 0.9, 1.0});
  world.addBox({2.6, 3.6, 0.35}, {0.5, 0.4, 0.35});
  world.addBox({-0.6, 3.8, 1.1}, {0.35, 0.2, 1.1});
  world.addBox({-2.6, 1.7, 0.7}, {0.3, 0.2, 0.7});
  world.addBox({-5.0, 2.9, 0.8}, {0.5, 0.4, 0.8});
  return world;
}

/// A pose of the optical frame on the rounded way around the block of `makeHall`, 0.6 m above the
/// floor, `distance` [m] from its start at (-4.2, -2.7); one round is `kHallRound` metres.
constexpr double kHallRound = 2.0 * (6.4 + 3.4) + 2.0 * M_PI;
inline Eigen::Isometry3d hallPose(double distance) {
  const double sides[4] = {6.4, 3.4, 6.4, 3.4};
  Eigen::Vector3d position(-3.2, -2.7, 0.6);
  double yaw = 0.0;
  double left = std::fmod(distance, kHallRound);
  for (const double side : sides) {
    const Eigen::Vector3d ahead(std::cos(yaw), std::sin(yaw), 0.0);
    if (left <= side) return lookAlongX(position + left * ahead, yaw, 0.15);
    position += side * ahead;
    left -= side;
    const double turn = std::min(left, 0.5 * M_PI);  // a bend of 1 m radius
    const Eigen::Vector3d leftward(-ahead.y(), ahead.x(), 0.0);
    const Eigen::Vector3d bend = std::sin(turn) * ahead + (1.0 - std::cos(turn)) * leftward;
    if (left <= 0.5 * M_PI) return lookAlongX(position + bend, yaw + turn, 0.15);
    position += ahead + leftward;
    yaw += 0.5 * M_PI;
    left -= 0.5 * M_PI;
  }
  return lookAlongX(position, yaw, 0.15);
}

/// The identity, odometry and edges of a frontend's keyframes along a way, with noise.
class SyntheticOdometry {
 public:
  SyntheticOdometry(std::string name, unsigned seed) : name_(std::move(name)), random_(seed) {}

  double translation_noise = 0.006;  ///< of an odometry edge [m]
  double rotation_noise = 0.004;     ///< of an odometry edge [rad]
  std::uint64_t session = 1;
  std::uint32_t history = 0;  ///< edges to keyframes before the previous one

  std::vector<Eigen::Isometry3d> truth;  ///< T_world_camera of every keyframe

 protected:
  /// The keyframe at a true pose, 1 s after the one before; its planes are left to the caller.
  Keyframe moveTo(const Eigen::Isometry3d& T_world_camera) {
    const auto number = static_cast<std::uint32_t>(truth.size());
    truth.push_back(T_world_camera);
    Keyframe keyframe;
    keyframe.id = {name_, session, number};
    keyframe.stamp = 100.0 + number;
    for (std::uint32_t back = 1; back <= std::min(number, 1 + history); ++back) {
      keyframe.edges.push_back(edgeTo(number - back));
    }
    if (number > 0) {
      T_odom_camera_ = T_odom_camera_ * keyframe.edges.front().T_other_this;
    } else {
      T_odom_camera_.linear() = T_world_camera.linear();
    }
    keyframe.T_odom_camera = T_odom_camera_;
    return keyframe;
  }

  unsigned draw() { return static_cast<unsigned>(random_()); }

 private:
  /// Measured from the newest keyframe.
  RelativePoseEdge edgeTo(std::uint32_t number) {
    RelativePoseEdge edge;
    edge.other = {name_, session, number};
    edge.T_other_this = truth[number].inverse() * truth.back() * error();
    edge.information.topLeftCorner<3, 3>() *= 1.0 / (translation_noise * translation_noise);
    edge.information.bottomRightCorner<3, 3>() *= 1.0 / (rotation_noise * rotation_noise);
    return edge;
  }

  Eigen::Isometry3d error() {
    std::normal_distribution<double> gauss;
    Vector6d xi;
    for (int i = 0; i < 6; ++i) {
      xi(i) = (i < 3 ? translation_noise : rotation_noise) * gauss(random_);
    }
    return expSe3(xi);
  }

  std::string name_;
  std::mt19937 random_;
  Eigen::Isometry3d T_odom_camera_ = Eigen::Isometry3d::Identity();
};

/// What a frontend would send on its way through a world: keyframes with noisy odometry.
class SyntheticRobot : public SyntheticOdometry {
 public:
  SyntheticRobot(const SyntheticPlanes& world, std::string name, unsigned seed)
      : SyntheticOdometry(std::move(name), seed), world_(world) {}

  /// The keyframe at a true pose, 1 s after the one before.
  Keyframe see(const Eigen::Isometry3d& T_world_camera) {
    Keyframe keyframe = moveTo(T_world_camera);
    CodecOptions codec;
    codec.encoding = PlaneCloudEncoding::kRaw;
    keyframe.planes = encode(world_.view(T_world_camera, 1.5e-3, draw()), codec);
    return keyframe;
  }

 private:
  const SyntheticPlanes& world_;
};

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "painted_world.h"

namespace planecloud {

/// Corridors between square blocks: crossings are `kPitch` apart, the first one at the origin.
namespace city_block {
constexpr double kPitch = 12.0;     ///< [m]
constexpr int kCrossings = 5;       ///< along each side
constexpr double kHalfWidth = 1.2;  ///< of a corridor [m]
constexpr double kHeight = 2.6;     ///< [m]
}  // namespace city_block

/// Boxes of random sizes along both walls of a street in either direction.
inline void furnishStreet(int line, int street, std::mt19937& random, PaintedWorld& world) {
  using namespace city_block;
  std::uniform_real_distribution<double> uniform;
  const auto paint = [&] { return static_cast<std::uint32_t>(random()); };
  const auto between = [&](double low, double high) {
    return low + (high - low) * uniform(random);
  };
  for (const bool along_x : {true, false}) {
    for (const double side : {-1.0, 1.0}) {
      double way = street * kPitch + kHalfWidth + between(0.2, 1.5);
      while (way < (street + 1) * kPitch - kHalfWidth - 1.2) {
        const double length = between(0.3, 1.2);
        const double depth = between(0.15, 0.45);
        const double height = between(0.3, 2.1);
        const double place = way + 0.5 * length;
        const double across = line * kPitch + side * (kHalfWidth - 0.5 * depth);
        const Eigen::Vector3d half(0.5 * length, 0.5 * depth, 0.5 * height);
        if (along_x) {
          world.addBox({place, across, half.z()}, half, paint());
        } else {
          world.addBox({across, place, half.z()}, {half.y(), half.x(), half.z()}, paint());
        }
        way += length + between(0.4, 2.0);
      }
    }
  }
}

/// A city block of corridors, 2.4 m wide and 2.6 m high, around square blocks of 9.6 m: boxes of
/// random sizes along all walls, painted by seed.
inline PaintedWorld makeCityBlock(unsigned seed) {
  using namespace city_block;
  std::mt19937 random(seed);
  const auto paint = [&] { return static_cast<std::uint32_t>(random()); };
  PaintedWorld world;
  const double middle = 0.5 * (kCrossings - 1) * kPitch;
  const double half = middle + kHalfWidth;
  world.addBox({middle, middle, 0.5 * kHeight}, {half, half, 0.5 * kHeight}, paint());
  for (int row = 0; row + 1 < kCrossings; ++row) {
    for (int column = 0; column + 1 < kCrossings; ++column) {
      const double block = 0.5 * kPitch - kHalfWidth;
      world.addBox({kPitch * (column + 0.5), kPitch * (row + 0.5), 0.5 * kHeight},
                   {block, block, 0.5 * kHeight}, paint());
    }
  }
  for (int line = 0; line < kCrossings; ++line) {
    for (int street = 0; street + 1 < kCrossings; ++street) {
      furnishStreet(line, street, random, world);
    }
  }
  return world;
}

/// A way through a city block: straight along the corridors, at each crossing straight on or round
/// a bend, never back.
class CityWalk {
 public:
  explicit CityWalk(unsigned seed) : random_(seed) {
    std::uniform_int_distribution<int> crossing(1, city_block::kCrossings - 2);
    const Eigen::Vector2d start(crossing(random_), crossing(random_));
    heading_ = std::uniform_int_distribution<int>(0, 3)(random_);
    crossing_ = (start + ahead()).cast<int>();
    leg_ = {city_block::kPitch * start + kBend * ahead(), yaw(), 0.0, kStreet};
  }

  /// The optical frame, `step` metres further on.
  [[nodiscard]] Eigen::Isometry3d advance(double step) {
    way_ += step;
    total_ += step;
    while (way_ > leg_.length) nextLeg();
    const double angle = leg_.yaw + leg_.bend * way_ / kBend;
    const Eigen::Vector2d chord =
        leg_.bend == 0.0 ? Eigen::Vector2d(way_ * std::cos(angle), way_ * std::sin(angle))
                         : Eigen::Vector2d(std::sin(angle) - std::sin(leg_.yaw),
                                           std::cos(leg_.yaw) - std::cos(angle)) *
                               (kBend / leg_.bend);
    // No robot keeps to the middle.
    const double aside = 0.2 * std::sin(0.9 * total_);
    const Eigen::Vector2d place =
        leg_.start + chord + aside * Eigen::Vector2d(-std::sin(angle), std::cos(angle));
    return lookAlongX({place.x(), place.y(), 0.6}, angle + 0.18 * std::cos(0.9 * total_), 0.1);
  }

 private:
  static constexpr double kBend = 0.8;  // radius [m]
  static constexpr double kStreet = city_block::kPitch - 2.0 * kBend;

  struct Leg {
    Eigen::Vector2d start = Eigen::Vector2d::Zero();
    double yaw = 0.0;   // at its start [rad]
    double bend = 0.0;  // 1: to the left, -1: to the right
    double length = 0.0;
  };

  [[nodiscard]] double yaw() const { return 0.5 * M_PI * heading_; }
  [[nodiscard]] Eigen::Vector2d ahead() const {
    return {std::round(std::cos(yaw())), std::round(std::sin(yaw()))};
  }

  void nextLeg() {
    way_ -= leg_.length;
    const Eigen::Vector2d corner = city_block::kPitch * crossing_.cast<double>();
    if (in_street_) {
      const Eigen::Vector2d entry = corner - kBend * ahead();
      const double before = yaw();
      const int turn = chooseTurn();
      heading_ += turn;
      const double length = turn == 0 ? 2.0 * kBend : 0.5 * M_PI * kBend;
      leg_ = {entry, before, static_cast<double>(turn), length};
    } else {
      leg_ = {corner + kBend * ahead(), yaw(), 0.0, kStreet};
      crossing_ += ahead().cast<int>();
    }
    in_street_ = !in_street_;
  }

  /// -1, 0 or 1, such that there is a street.
  [[nodiscard]] int chooseTurn() {
    std::vector<int> turns;
    for (const int turn : {-1, 0, 1}) {
      const double angle = yaw() + 0.5 * M_PI * turn;
      const Eigen::Vector2i next(crossing_.x() + static_cast<int>(std::lround(std::cos(angle))),
                                 crossing_.y() + static_cast<int>(std::lround(std::sin(angle))));
      const bool inside = next.minCoeff() >= 0 && next.maxCoeff() < city_block::kCrossings;
      if (inside) turns.push_back(turn);
    }
    return turns[std::uniform_int_distribution<std::size_t>(0, turns.size() - 1)(random_)];
  }

  std::mt19937 random_;
  int heading_ = 0;                                     // quarter turns from x
  Eigen::Vector2i crossing_ = Eigen::Vector2i::Zero();  // the next one
  bool in_street_ = true;
  Leg leg_;
  double way_ = 0.0;    // on the leg [m]
  double total_ = 0.0;  // [m]
};

}  // namespace planecloud

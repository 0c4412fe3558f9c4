// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/rosbags/robot_path.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "planecloud_slam/rosbags/seeded_random.h"

namespace planecloud {
namespace {

constexpr double kStep = 1.0 / RobotPath::kStepsPerSecond;  // [s]
constexpr double kStandStill = 0.4;                         // before driving off [s]
constexpr double kSpacing = 0.02;                           // of the points of a line [m]
constexpr double kLookAhead = 0.5;                          // [m]
constexpr double kSlowestSpeed = 0.3;                       // while turning [m/s]

/// The line a robot follows: points every kSpacing; from the last it goes on at `loop_start`.
struct DriveLine {
  std::vector<Eigen::Vector2d> points;
  std::size_t loop_start = 0;
  bool endless = true;

  [[nodiscard]] std::size_t wrapped(std::size_t index) const {
    if (index < points.size()) return index;
    if (!endless) return points.size() - 1;
    return loop_start + (index - loop_start) % (points.size() - loop_start);
  }
};

void drawTo(DriveLine& line, const Eigen::Vector2d& end) {
  const Eigen::Vector2d start = line.points.back();
  const int count = std::max(1, static_cast<int>(std::lround((end - start).norm() / kSpacing)));
  for (int i = 1; i <= count; ++i) line.points.emplace_back(start + (end - start) * i / count);
}

DriveLine lineOf(DriveKind kind) {
  const Eigen::Vector2d north_west(1.1, 1.2);
  const Eigen::Vector2d north_east(10.9, 1.2);
  const Eigen::Vector2d south_east(10.9, -4.3);
  const Eigen::Vector2d south_west(1.1, -4.3);
  const auto through = [](std::initializer_list<Eigen::Vector2d> stops, std::size_t lead) {
    DriveLine line;
    line.points.push_back(*stops.begin());
    std::size_t stop = 0;
    for (const Eigen::Vector2d& next : stops) {
      if (stop > 0) drawTo(line, next);
      if (stop++ == lead) line.loop_start = line.points.size() - 1;
    }
    line.points.pop_back();  // the loop's last point is its first
    return line;
  };
  switch (kind) {
    case DriveKind::kLoop: {
      const Eigen::Vector2d start(3.6, 1.2);
      return through({start, north_east, south_east, south_west, north_west, start}, 0);
    }
    case DriveKind::kFromLab: {
      const Eigen::Vector2d merge(6.0, 1.2);
      return through({{6.0, 4.9}, merge, north_east, south_east, south_west, north_west, merge}, 1);
    }
    case DriveKind::kFarLoop: {
      const Eigen::Vector2d start(7.6, -4.3);
      return through({start, south_west, north_west, north_east, south_east, start}, 0);
    }
    case DriveKind::kHallway:
      break;
  }
  DriveLine line = through({{0.7, 1.2}, {14.2, 1.2}}, 0);
  line.endless = false;
  return line;
}

/// Two slow sines across the line [m], by seed and distance driven.
class Wander {
 public:
  explicit Wander(std::uint64_t seed) {
    SeededRandom random(hashOf(seed, 0x3a));
    for (Wave& wave : waves_) {
      wave = {random.uniform(0.03, 0.06), random.uniform(2.2, 6.0), random.uniform(0.0, 6.28)};
    }
  }

  [[nodiscard]] double at(double distance) const {
    double offset = 0.0;
    for (const Wave& wave : waves_) {
      offset += wave.amplitude * std::sin(2.0 * M_PI * distance / wave.length + wave.phase);
    }
    return offset;
  }

 private:
  struct Wave {
    double amplitude = 0.0;
    double length = 1.0;
    double phase = 0.0;
  };
  Wave waves_[2];
};

class Driver {
 public:
  Driver(DriveLine line, std::uint64_t seed)
      : line_(std::move(line)),
        wander_(seed),
        cruise_(SeededRandom(hashOf(seed, 0x5b)).uniform(0.43, 0.47)) {
    const Eigen::Vector2d start = line_.points[0];
    const Eigen::Vector2d ahead = line_.points[1] - start;
    state_.position = start;
    state_.heading = std::atan2(ahead.y(), ahead.x());
  }

  [[nodiscard]] const BaseState& state() const { return state_; }

  void step() {
    index_ = nearestAhead();
    const double curvature = curvatureToTarget();
    const double wanted_speed =
        atEnd() ? 0.0
                : std::clamp(cruise_ * (1.0 - 0.3 * std::abs(curvature)), kSlowestSpeed, cruise_);
    const auto approach = [](double value, double wanted, double limit) {
      return value + std::clamp(wanted - value, -limit * kStep, limit * kStep);
    };
    state_.speed = approach(state_.speed, wanted_speed, RobotPath::kMaxAcceleration);
    const double wanted_turn =
        std::clamp(state_.speed * curvature, -RobotPath::kMaxTurnRate, RobotPath::kMaxTurnRate);
    state_.turn_rate = approach(state_.turn_rate, wanted_turn, RobotPath::kMaxTurnAcceleration);
    const double middle = state_.heading + 0.5 * kStep * state_.turn_rate;
    state_.position += kStep * state_.speed * Eigen::Vector2d(std::cos(middle), std::sin(middle));
    state_.heading += kStep * state_.turn_rate;
  }

 private:
  [[nodiscard]] const Eigen::Vector2d& point(std::size_t index) const {
    return line_.points[line_.wrapped(index)];
  }
  /// Searches further than a corner is cut, so that the robot does not wait for the corner.
  [[nodiscard]] std::size_t nearestAhead() const {
    constexpr std::size_t kWindow = 40;
    std::size_t nearest = index_;
    for (std::size_t i = index_ + 1; i <= index_ + kWindow; ++i) {
      if (!line_.endless && i >= line_.points.size()) break;
      if ((point(i) - state_.position).squaredNorm() <
          (point(nearest) - state_.position).squaredNorm()) {
        nearest = i;
      }
    }
    return nearest;
  }
  /// A robot on an open line brakes in time.
  [[nodiscard]] bool atEnd() const {
    const double left = kSpacing * static_cast<double>(line_.points.size() - index_);
    const double braking = state_.speed * state_.speed / (2.0 * RobotPath::kMaxAcceleration) + 0.05;
    return !line_.endless && left < braking;
  }
  /// Pure pursuit: the arc from here to the point kLookAhead further on the wandering line.
  [[nodiscard]] double curvatureToTarget() const {
    const std::size_t target = index_ + static_cast<std::size_t>(kLookAhead / kSpacing);
    const Eigen::Vector2d along = (point(target) - point(target - 5)).normalized();
    const Eigen::Vector2d left(-along.y(), along.x());
    const Eigen::Vector2d goal =
        point(target) + wander_.at(kSpacing * static_cast<double>(target)) * left;
    const Eigen::Vector2d offset = goal - state_.position;
    const double sideways =
        -std::sin(state_.heading) * offset.x() + std::cos(state_.heading) * offset.y();
    return 2.0 * sideways / std::max(offset.squaredNorm(), 0.04);
  }

  DriveLine line_;
  Wander wander_;
  double cruise_;  ///< [m/s]
  BaseState state_;
  std::size_t index_ = 0;  ///< of the line's point nearest to the robot
};

}  // namespace

RobotPath::RobotPath(DriveKind kind, std::uint64_t seed, double duration) {
  if (!(duration > 0.0 && duration <= 3600.0)) {
    std::ostringstream text;
    text << "duration = " << duration << ": must be in (0, 3600] s";
    throw std::invalid_argument(text.str());
  }
  const auto steps = static_cast<std::size_t>(std::ceil(duration * kStepsPerSecond));
  Driver driver(lineOf(kind), seed);
  states_.reserve(steps + 1);
  for (std::size_t i = 0; i <= steps; ++i) {
    states_.push_back(driver.state());
    if (static_cast<double>(i) * kStep >= kStandStill) driver.step();
  }
}

std::vector<BaseState> wheelOdometry(const RobotPath& path, std::uint64_t seed) {
  SeededRandom random(hashOf(seed, 0x0d));
  const auto scaleError = [&] {
    return (random.chance(0.5) ? 1.0 : -1.0) * random.uniform(0.01, 0.02);
  };
  const double distance_scale = 1.0 + scaleError();
  const double angle_scale = 1.0 + scaleError();
  // White noise on the rates; its integral over a minute is some millimetres and half a degree.
  constexpr double kSpeedNoise = 0.02;  // [m/s] per step
  constexpr double kTurnNoise = 0.02;   // [rad/s] per step
  std::vector<BaseState> odometry;
  odometry.reserve(path.states().size());
  BaseState pose;
  for (const BaseState& truth : path.states()) {
    const bool moves = truth.speed > 0.0 || truth.turn_rate != 0.0;
    const double noise = moves ? 1.0 : 0.0;
    pose.speed = truth.speed * distance_scale + noise * kSpeedNoise * random.normal();
    pose.turn_rate = truth.turn_rate * angle_scale + noise * kTurnNoise * random.normal();
    odometry.push_back(pose);
    const double middle = pose.heading + 0.5 * kStep * pose.turn_rate;
    pose.position += kStep * pose.speed * Eigen::Vector2d(std::cos(middle), std::sin(middle));
    pose.heading += kStep * pose.turn_rate;
  }
  return odometry;
}

Eigen::Isometry3d toTransform(const BaseState& state) {
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  transform.translate(Eigen::Vector3d(state.position.x(), state.position.y(), 0.0));
  transform.rotate(Eigen::AngleAxisd(state.heading, Eigen::Vector3d::UnitZ()));
  return transform;
}

}  // namespace planecloud

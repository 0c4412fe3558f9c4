// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
//
// A robot that drives around the synthetic hall without a camera: sends the keyframes it would make
// as a frontend does, acknowledgements and all. Private parameters: robot, session, start [m],
// distance [m], period [s] between keyframes, seed; `hint_robot`: hints at the keyframes of a robot
// that started at 0 m in session 1; `lost_at`: the keyframe that begins a new segment.
#include <ros/ros.h>

#include <cmath>
#include <string>
#include <thread>

#include "../synthetic_robot.h"
#include "planecloud_slam/frontend_node/keyframe_sender.h"
#include "planecloud_slam/planecloud_msgs/node_main.h"

namespace planecloud {
namespace {

constexpr double kSpacing = 0.3;  // between keyframes [m]

class Drive {
 public:
  explicit Drive(const ros::NodeHandle& private_node)
      : robot_(private_node.param<std::string>("robot", "robot1")),
        session_(static_cast<std::uint64_t>(private_node.param("session", 1))),
        start_(private_node.param("start", 0.0)),
        distance_(private_node.param("distance", 6.0)),
        period_(private_node.param("period", 0.1)),
        lost_at_(private_node.param("lost_at", -1)),
        hint_robot_(private_node.param<std::string>("hint_robot", "")),
        hall_(makeHall()),
        driver_(hall_, robot_, static_cast<unsigned>(private_node.param("seed", 1))),
        sender_(ros::NodeHandle(), LinkOptions(), robot_, session_) {
    driver_.session = session_;
  }

  void run() {
    const int last = static_cast<int>(distance_ / kSpacing + 1e-6);
    for (int i = 0; i <= last && ros::ok(); ++i) {
      const double s = kSpacing * i;
      Keyframe keyframe = driver_.see(hallPose(start_ + s));
      if (static_cast<int>(keyframe.id.number) == lost_at_) keyframe.edges.clear();
      addHint(start_ + s, keyframe);
      sender_.send(std::move(keyframe), "camera_rgb_optical_frame");
      ros::WallDuration(period_).sleep();
    }
  }

 private:
  /// Where the other robot, or this one a round earlier, was nearest to `distance`.
  void addHint(double distance, Keyframe& keyframe) const {
    const double first_round = std::fmod(distance, kHallRound);
    const KeyframeId hint{hint_robot_, 1, static_cast<std::uint32_t>(first_round / kSpacing)};
    const bool is_past =
        hint.robot != robot_ || hint.session != session_ || hint.number + 10 < keyframe.id.number;
    if (!hint_robot_.empty() && is_past) keyframe.closure_hints.push_back(hint);
  }

  const std::string robot_;
  const std::uint64_t session_;
  const double start_;
  const double distance_;
  const double period_;
  const int lost_at_;
  const std::string hint_robot_;
  const SyntheticPlanes hall_;
  SyntheticRobot driver_;
  KeyframeSender sender_;
};

}  // namespace
}  // namespace planecloud

int main(int argc, char** argv) {
  return planecloud::runNode(argc, argv, "synthetic_robot", [] {
    planecloud::Drive drive(ros::NodeHandle("~"));
    std::thread driving([&drive] { drive.run(); });
    planecloud::spinUntilStopped();
    driving.join();
  });
}

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/planecloud_msgs/node_main.h"

#include <ros/ros.h>
#include <ros/spinner.h>

#include <csignal>
#include <exception>

namespace planecloud {
namespace {

volatile std::sig_atomic_t stop_requested = 0;

void requestStop(int) { stop_requested = 1; }

}  // namespace

int runNode(int argc, char** argv, const std::string& name, const std::function<void()>& run) {
  ros::init(argc, argv, name, ros::init_options::NoSigintHandler);
  std::signal(SIGINT, requestStop);
  std::signal(SIGTERM, requestStop);
  try {
    ros::start();
    ros::AsyncSpinner spinner(2);
    spinner.start();
    run();
  } catch (const std::exception& error) {
    ROS_FATAL_STREAM(error.what());
    ros::shutdown();
    return 1;
  }
  ros::shutdown();
  return 0;
}

void spinUntilStopped() {
  while (ros::ok() && stop_requested == 0) ros::WallDuration(0.05).sleep();
}

}  // namespace planecloud

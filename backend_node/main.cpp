// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <ros/ros.h>

#include "planecloud_slam/backend_node/backend_node.h"
#include "planecloud_slam/planecloud_msgs/node_main.h"
#include "planecloud_slam/planecloud_msgs/node_parameters.h"

int main(int argc, char** argv) {
  using planecloud_slam::BackendNode;
  using planecloud_slam::BackendNodeOptions;
  return planecloud_slam::runNode(argc, argv, "backend_node", [] {
    const ros::NodeHandle node;
    const ros::NodeHandle private_node("~");
    const auto options = planecloud_slam::loadNodeOptions<BackendNodeOptions>(private_node);
    const BackendNode backend(node, private_node, options);
    planecloud_slam::spinUntilStopped();
  });
}

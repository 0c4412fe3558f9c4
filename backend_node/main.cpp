// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <ros/ros.h>

#include "planecloud_slam/backend_node/backend_node.h"
#include "planecloud_slam/planecloud_msgs/node_main.h"
#include "planecloud_slam/planecloud_msgs/node_parameters.h"

int main(int argc, char** argv) {
  using planecloud::BackendNode;
  using planecloud::BackendNodeOptions;
  return planecloud::runNode(argc, argv, "backend_node", [] {
    const ros::NodeHandle node;
    const ros::NodeHandle private_node("~");
    const auto options = planecloud::loadNodeOptions<BackendNodeOptions>(private_node);
    const BackendNode backend(node, private_node, options);
    planecloud::spinUntilStopped();
  });
}

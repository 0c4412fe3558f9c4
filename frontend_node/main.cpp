// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <ros/ros.h>

#include "planecloud_slam/frontend_node/frontend_node.h"
#include "planecloud_slam/planecloud_msgs/node_main.h"
#include "planecloud_slam/planecloud_msgs/node_parameters.h"

int main(int argc, char** argv) {
  using planecloud::FrontendNode;
  using planecloud::FrontendNodeOptions;
  return planecloud::runNode(argc, argv, "frontend_node", [] {
    const ros::NodeHandle node;
    const ros::NodeHandle private_node("~");
    const auto options = planecloud::loadNodeOptions<FrontendNodeOptions>(private_node);
    FrontendNode frontend(node, private_node, options);
    planecloud::spinUntilStopped();
    frontend.finish();
  });
}

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sensor_msgs/Image.h>

#include <functional>
#include <memory>

#include "planecloud_slam/frontend_node/frontend_node_options.h"

namespace planecloud {

/// Pairs colour and depth images by their stamps, exactly or approximately. Not for several threads
/// at once.
class RgbdSynchronizer {
 public:
  using OnPair =
      std::function<void(const sensor_msgs::ImageConstPtr&, const sensor_msgs::ImageConstPtr&)>;

  RgbdSynchronizer(const InputOptions& options, OnPair on_pair);
  ~RgbdSynchronizer();

  void addColor(const sensor_msgs::ImageConstPtr& color);
  void addDepth(const sensor_msgs::ImageConstPtr& depth);
  /// Forgets the images that wait for a partner.
  void clear();

 private:
  class Policy;
  const InputOptions options_;
  const OnPair on_pair_;
  std::unique_ptr<Policy> policy_;
};

}  // namespace planecloud

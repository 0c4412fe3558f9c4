// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>

#include <cstdint>
#include <memory>
#include <mutex>
#include <utility>

#include "planecloud_slam/frontend_node/frontend_node_options.h"

namespace planecloud {

/// The options as dynamic_reconfigure changes them while the node runs: a server for each part that
/// has something to change, `<node>/plane_fit` and so on, so that parameters keep their names.
/// Safe from any thread.
class LiveOptions {
 public:
  /// `initial` must pass its check: it is what the parameter server has.
  LiveOptions(const ros::NodeHandle& private_node, const FrontendNodeOptions& initial);
  ~LiveOptions();

  /// The options now and the number of changes that led to them.
  [[nodiscard]] std::pair<FrontendNodeOptions, std::uint64_t> get() const;

 private:
  struct Servers;

  template <typename Config, typename Part>
  void serve(const char* part, Part& options);

  mutable std::mutex mutex_;
  FrontendNodeOptions options_;
  std::uint64_t changes_ = 0;
  const ros::NodeHandle node_;
  std::unique_ptr<Servers> servers_;
};

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>

#include <string>

#include "planecloud_slam/plane_fit/option_values.h"

namespace planecloud {

/// All parameters below `node`, nested names joined by `/` (`link/outbox_bytes`), items of a list
/// by spaces. Throws std::invalid_argument for types that no option has.
[[nodiscard]] OptionValues readNodeParameters(const ros::NodeHandle& node);

/// Logs a warning for each key of `unknown` and the nearest of `known`.
void warnUnknownParameters(const std::string& name_space, const OptionValues& unknown,
                           const OptionValues& known);

/// The private parameters of a node as its options, checked. Throws std::invalid_argument naming
/// key, value and range; warns about keys that no option has.
template <typename Options>
[[nodiscard]] Options loadNodeOptions(const ros::NodeHandle& private_node) {
  Options options;
  OptionValues values = readNodeParameters(private_node);
  const OptionValues known = dumpOptions(options);
  takeOptions(values, options);
  warnUnknownParameters(private_node.getNamespace(), values, known);
  options.check();
  return options;
}

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/planecloud_msgs/node_parameters.h"

#include <ros/console.h>

#include <set>
#include <stdexcept>

namespace planecloud {
namespace {

/// Read by image_transport and roscpp themselves.
const std::set<std::string> kForeignKeys = {"image_transport", "tcp_nodelay"};

std::string scalarText(const std::string& key, XmlRpc::XmlRpcValue& value) {
  switch (value.getType()) {
    case XmlRpc::XmlRpcValue::TypeBoolean:
      return formatOption(static_cast<bool&>(value));
    case XmlRpc::XmlRpcValue::TypeInt:
      return formatOption(static_cast<int&>(value));
    case XmlRpc::XmlRpcValue::TypeDouble:
      return formatOption(static_cast<double&>(value));
    case XmlRpc::XmlRpcValue::TypeString:
      return static_cast<std::string&>(value);
    default:
      throw std::invalid_argument(key + ": must be a number, a text, true or false");
  }
}

void flatten(const std::string& key, XmlRpc::XmlRpcValue& value, OptionValues& values) {
  if (value.getType() == XmlRpc::XmlRpcValue::TypeStruct) {
    for (auto& [name, member] : value) {
      flatten(key.empty() ? name : key + "/" + name, member, values);
    }
  } else if (value.getType() == XmlRpc::XmlRpcValue::TypeArray) {
    std::string items;
    for (int i = 0; i < value.size(); ++i) {
      items += (i == 0 ? "" : " ") + scalarText(key, value[i]);
    }
    values[key] = items;
  } else {
    values[key] = scalarText(key, value);
  }
}

}  // namespace

OptionValues readNodeParameters(const ros::NodeHandle& node) {
  OptionValues values;
  XmlRpc::XmlRpcValue tree;
  if (node.getParam(node.getNamespace(), tree) &&
      tree.getType() == XmlRpc::XmlRpcValue::TypeStruct) {
    flatten("", tree, values);
  }
  return values;
}

void warnUnknownParameters(const std::string& name_space, const OptionValues& unknown,
                           const OptionValues& known) {
  for (const auto& [key, value] : unknown) {
    if (kForeignKeys.count(key) > 0) continue;
    ROS_WARN_STREAM("unknown parameter " << name_space << "/" << key << " = " << value
                                         << " has no effect: is " << nearestKey(key, known)
                                         << " meant?");
  }
}

}  // namespace planecloud

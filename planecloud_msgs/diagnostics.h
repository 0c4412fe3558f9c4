// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>
#include <ros/time.h>

#include <sstream>
#include <string>

namespace planecloud {

/// One status of a node for `/diagnostics`, filled line by line.
class DiagnosticStatus {
 public:
  DiagnosticStatus(const std::string& node, const std::string& part, const std::string& hardware) {
    status_.name = node + ": " + part;
    status_.hardware_id = hardware;
    status_.level = diagnostic_msgs::DiagnosticStatus::OK;
    status_.message = "ok";
  }

  void warn(const std::string& message) {
    status_.level = diagnostic_msgs::DiagnosticStatus::WARN;
    status_.message = message;
  }

  template <typename Value>
  void add(const std::string& key, const Value& value) {
    std::ostringstream text;
    text << value;
    diagnostic_msgs::KeyValue line;
    line.key = key;
    line.value = text.str();
    status_.values.push_back(line);
  }

  [[nodiscard]] diagnostic_msgs::DiagnosticArray toMessage() const {
    diagnostic_msgs::DiagnosticArray message;
    message.header.stamp = ros::Time::now();
    message.status = {status_};
    return message;
  }

 private:
  diagnostic_msgs::DiagnosticStatus status_;
};

}  // namespace planecloud

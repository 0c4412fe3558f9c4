// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "planecloud_slam/frontend_node/frontend_options.h"
#include "planecloud_slam/frontend_node/outbox.h"
#include "planecloud_slam/plane_fit/option_fields.h"

namespace planecloud {

/// Whether the images are rectified already.
enum class RectifyMode {
  kAuto,    ///< the colour topic's name says: `rect` in it means rectified
  kNever,   ///< they are rectified: nothing to do, camera_info's P describes them
  kAlways,  ///< they are raw: camera_info's K and D describe them
};

[[nodiscard]] std::string toString(RectifyMode mode);
/// Throws std::invalid_argument naming the choices.
void fromString(const std::string& text, RectifyMode& mode);

/// Where images come from and how they are paired.
struct InputOptions {
  RectifyMode rectify = RectifyMode::kAuto;
  bool exact_sync = false;     ///< pair equal stamps only
  double max_interval = 0.04;  ///< between the stamps of a pair [s], [0, 1]
  int subscriber_queue = 10;   ///< messages roscpp keeps per image topic, [1, 100000]
  int sync_queue = 10;         ///< messages that wait for their partner, [1, 100000]
  int frame_queue = 3;         ///< pairs that wait for the tracker, [1, 100000]
  bool drop_frames = true;  ///< drop the oldest pair when the tracker is late; false: wait for it
  double idle_timeout =
      5.0;  ///< without images, complete the open keyframe [s], 0: never, [0, 3600]

  template <typename Self, typename Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("rectify", self.rectify);
    visit("exact_sync", self.exact_sync);
    visit("max_interval", self.max_interval);
    visit("subscriber_queue", self.subscriber_queue);
    visit("sync_queue", self.sync_queue);
    visit("frame_queue", self.frame_queue);
    visit("drop_frames", self.drop_frames);
    visit("idle_timeout", self.idle_timeout);
  }
  /// Throws std::invalid_argument naming key, value and range.
  void check() const;
};

/// Everything the frontend node can be told, by the names of its private parameters.
struct FrontendNodeOptions {
  std::string robot;                ///< unique name; empty: the namespace, else "robot"
  std::string session;              ///< start of this run [ns]; empty: now
  std::string odom_frame = "odom";  ///< of the robot's base; empty: visual odometry alone
  std::string base_frame = "base_footprint";
  /// tf frame in which the wheels carry the camera, such as `odom`: their motion is where tracking
  /// begins to look, and what it must roughly agree with. Empty: none.
  std::string guess_frame;
  bool publish_odom_tf = false;   ///< visual odometry as tf odom -> base
  double tf_wait = 0.2;           ///< longest wait for a keyframe's tf [s], [0, 5]
  double shutdown_timeout = 3.0;  ///< longest wait for acknowledgements at the end [s], [0, 60]
  InputOptions input;
  LinkOptions link;
  FrontendOptions frontend;

  template <typename Self, typename Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("robot", self.robot);
    visit("session", self.session);
    visit("odom_frame", self.odom_frame);
    visit("base_frame", self.base_frame);
    visit("guess_frame", self.guess_frame);
    visit("publish_odom_tf", self.publish_odom_tf);
    visit("tf_wait", self.tf_wait);
    visit("shutdown_timeout", self.shutdown_timeout);
    InputOptions::fields(self.input, visit);
    visitFields("link/", self.link, visit);
    FrontendOptions::fields(self.frontend, visit);
  }
  /// Throws std::invalid_argument naming key, value and range.
  void check() const;
};

/// The session that `text` names, or `now` when it is empty [ns].
/// Throws std::invalid_argument when it is no number above 0.
[[nodiscard]] std::uint64_t parseSession(const std::string& text, std::uint64_t now);

/// The robot's name: `name`, else the namespace without its first slash, else "robot".
[[nodiscard]] std::string robotName(const std::string& name, const std::string& name_space);

}  // namespace planecloud

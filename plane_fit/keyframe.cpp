// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/plane_fit/keyframe.h"

namespace planecloud {

std::string toString(const KeyframeId& id) {
  return id.robot + "/" + std::to_string(id.session) + "/" + std::to_string(id.number);
}

}  // namespace planecloud

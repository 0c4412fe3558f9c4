// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>

#include "planecloud_slam/icap/icap_options.h"
#include "planecloud_slam/plane_fit/plane_cloud_codec.h"
#include "planecloud_slam/plane_fit/reconstruction.h"
#include "planecloud_slam/planecloud_msgs/conversions.h"

/// Sends a plane cloud through encoder, message and decoder; prints how many planes arrived.
int main() {
  using namespace planecloud;
  PlaneCloud cloud;
  cloud.camera = {640, 480, 525.0, 525.0, 319.5, 239.5, {}};
  cloud.tiles.push_back({{0, 0, 64, 64}, {0.0F, 0.0F, 0.5F}});
  IcapOptions().check();
  const planecloud_slam::PlaneCloud message =
      toMessage(encode(cloud, CodecOptions()), 1.0, "camera");
  const PlaneCloud received = decode(fromMessage(message));
  std::cout << received.tiles.size() << " plane received\n";
  return received.tiles.size() == 1 ? 0 : 1;
}

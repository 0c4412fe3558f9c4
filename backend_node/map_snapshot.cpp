// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/backend_node/map_snapshot.h"

#include "planecloud_slam/plane_fit/plane_cloud_codec.h"

namespace planecloud {

PlaneCloud MapPlanes::operator*() const { return decoded_ ? *decoded_ : decode(keyframe_->planes); }

const CameraIntrinsics& MapPlanes::camera() const {
  return decoded_ ? decoded_->camera : keyframe_->planes.camera;
}

std::size_t MapPlanes::count() const {
  return decoded_ ? decoded_->tiles.size() : keyframe_->planes.plane_count;
}

}  // namespace planecloud

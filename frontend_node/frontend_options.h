// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "planecloud_slam/frontend_node/dense_tracker_options.h"
#include "planecloud_slam/frontend_node/history_options.h"
#include "planecloud_slam/frontend_node/keyframe_selector.h"
#include "planecloud_slam/frontend_node/keyframe_texture.h"
#include "planecloud_slam/frontend_node/local_map.h"
#include "planecloud_slam/frontend_node/loss_options.h"
#include "planecloud_slam/plane_fit/option_fields.h"
#include "planecloud_slam/plane_fit/plane_cloud_codec.h"
#include "planecloud_slam/plane_fit/quadtree_fitter.h"

namespace planecloud {

/// Everything a frontend can be told; names as in ROS parameters and YAML files.
struct FrontendOptions {
  /// Remap images of a camera with lens distortion to the pinhole without it; false: track as if
  /// there were no distortion. Without effect on cameras that have none.
  bool undistort = true;
  /// The camera moves in parallel to a flat floor, as on a robot with wheels: its height, roll and
  /// pitch stay those of the start, exactly.
  bool planar = false;
  DenseTrackerOptions tracking;
  KeyframeSelectorOptions keyframe;
  LossOptions lost;
  HistoryOptions history;
  LocalMapOptions local_map;
  QuadtreeFitterOptions plane_fit;
  CodecOptions codec;
  TextureOptions texture;

  template <typename Self, typename Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("undistort", self.undistort);
    visit("planar", self.planar);
    visitFields("tracking/", self.tracking, visit);
    visitFields("keyframe/", self.keyframe, visit);
    visitFields("lost/", self.lost, visit);
    visitFields("history/", self.history, visit);
    visitFields("local_map/", self.local_map, visit);
    visitFields("plane_fit/", self.plane_fit, visit);
    visitFields("codec/", self.codec, visit);
    visitFields("texture/", self.texture, visit);
  }

  /// Throws std::invalid_argument naming key, value and range.
  void check() const;
};

}  // namespace planecloud

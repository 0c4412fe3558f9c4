// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "planecloud_slam/backend_node/edge_list.h"
#include "planecloud_slam/backend_node/graph_edge.h"
#include "planecloud_slam/backend_node/rejected_closures.h"
#include "planecloud_slam/plane_fit/keyframe.h"
#include "planecloud_slam/plane_fit/plane_cloud.h"

namespace planecloud {

/// The planes of a keyframe. A map of ten thousand decoded ones would fill the memory, so they are
/// kept as they travelled and decoded anew at each access: keep the result of `*` while you use it.
class MapPlanes {
 public:
  MapPlanes() = default;
  /// Of a keyframe that passed checkKeyframe.
  explicit MapPlanes(std::shared_ptr<const Keyframe> keyframe) : keyframe_(std::move(keyframe)) {}
  /// Planes that were never encoded.
  explicit MapPlanes(std::shared_ptr<const PlaneCloud> decoded) : decoded_(std::move(decoded)) {}

  [[nodiscard]] PlaneCloud operator*() const;
  [[nodiscard]] const CameraIntrinsics& camera() const;
  /// How many there are.
  [[nodiscard]] std::size_t count() const;

 private:
  std::shared_ptr<const Keyframe> keyframe_;
  std::shared_ptr<const PlaneCloud> decoded_;
};

/// A keyframe of the map. Shared between snapshots: only poses change from one to the next.
struct MapKeyframe {
  KeyframeId id;
  double stamp = 0.0;
  Eigen::Isometry3d T_odom_camera = Eigen::Isometry3d::Identity();
  /// As received (encoded planes, texture) but for its edges and hints, which went into the graph.
  std::shared_ptr<const Keyframe> keyframe;
  MapPlanes planes;
};

/// The map at one moment, immutable: publishers read it while the backend goes on.
struct MapSnapshot {
  struct Node {
    std::shared_ptr<const MapKeyframe> keyframe;
    Eigen::Isometry3d T_map_camera = Eigen::Isometry3d::Identity();
    int component = 0;  ///< connected component, 0 = the oldest
  };
  std::uint64_t revision = 0;  ///< grows with every change
  std::vector<Node> nodes;     ///< ordered by id
  EdgeList edges;
  std::deque<RejectedClosure> rejected;  ///< the newest, between keyframes of `nodes`
  int components = 0;
};

}  // namespace planecloud

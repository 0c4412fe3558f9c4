// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "planecloud_slam/backend_node/backend_options.h"
#include "planecloud_slam/plane_fit/keyframe.h"
#include "planecloud_slam/plane_fit/plane_cloud.h"

namespace planecloud_slam {

enum class EdgeKind { kOdometry, kHistory, kClosure };

/// An edge of the graph as others see it.
struct GraphEdge {
  EdgeKind kind = EdgeKind::kOdometry;
  KeyframeId from;
  KeyframeId to;
  Eigen::Isometry3d T_from_to = Eigen::Isometry3d::Identity();
  Matrix6d information = Matrix6d::Zero();  ///< at `to`; see se3.h
  bool inter_robot = false;
};

/// A keyframe of the map. Shared between snapshots: only poses change from one to the next.
struct MapKeyframe {
  KeyframeId id;
  double stamp = 0.0;
  Eigen::Isometry3d T_odom_camera = Eigen::Isometry3d::Identity();
  std::shared_ptr<const Keyframe> keyframe;  ///< as received (encoded planes, texture)
  std::shared_ptr<const PlaneCloud> planes;  ///< decoded
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
  std::vector<GraphEdge> edges;
  int components = 0;
};

enum class InsertionStatus {
  kInserted,
  kDuplicate,  ///< this id is already in the map: ignored
  kRefused,    ///< malformed; `reason` says why. Nothing changed.
  kNameClash,  ///< two running sessions of one robot name; `reason` names both. Nothing changed.
};

/// What became of one keyframe.
struct InsertionResult {
  InsertionStatus status = InsertionStatus::kRefused;
  std::string reason;               ///< for people, empty when inserted
  std::vector<GraphEdge> closures;  ///< accepted now
  int rejected_closures = 0;
  bool optimised = false;
  double optimize_time = 0.0;  ///< left to callers with a clock; unused in the core [s]
};

struct BackendStatistics {
  std::size_t keyframes = 0;
  std::size_t closures_intra = 0;
  std::size_t closures_inter = 0;
  std::map<std::string, std::size_t> rejected;  ///< closures by reason
  int components = 0;
};

/// The global map: pose graph, loop closures, optimisation (paper sec. 3.1, 3.2, 3.4).
/// No threads, no clock, no logging; calls from one thread only, snapshots may be read from any.
class Backend {
 public:
  /// Throws std::invalid_argument when `options` fail their check.
  explicit Backend(const BackendOptions& options);
  ~Backend();
  Backend(Backend&&) noexcept;
  Backend& operator=(Backend&&) noexcept;

  /// Adds a keyframe, looks for closures, optimises when it found any. Never throws for bad data.
  InsertionResult insert(Keyframe keyframe);

  /// Optimises the whole graph.
  void optimize();

  /// Forgets everything.
  void reset();

  [[nodiscard]] std::shared_ptr<const MapSnapshot> snapshot() const;
  [[nodiscard]] BackendStatistics statistics() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace planecloud_slam

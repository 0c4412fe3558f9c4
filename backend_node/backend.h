// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "planecloud_slam/backend_node/backend_options.h"
#include "planecloud_slam/backend_node/map_snapshot.h"
#include "planecloud_slam/backend_node/pose_graph.h"
#include "planecloud_slam/plane_fit/keyframe.h"

namespace planecloud {

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
  std::size_t coplanar_edges = 0;
  std::map<std::string, std::size_t> rejected;  ///< closures by reason
  int components = 0;
};

/// An optimisation of the whole graph apart from the backend: take it with
/// Backend::startOptimisation, run it anywhere, give it back to Backend::finishOptimisation.
class GraphOptimisation {
 public:
  /// `revision`: of the map `graph` was copied from.
  explicit GraphOptimisation(PoseGraph graph, std::uint64_t revision = 0)
      : graph_(std::move(graph)), revision_(revision) {}

  /// May take seconds. Touches nothing but itself, so that it can run on a thread of its own.
  void run() { summary_ = graph_.optimize(); }

  [[nodiscard]] const PoseGraph& graph() const { return graph_; }
  [[nodiscard]] const OptimisationSummary& summary() const { return summary_; }
  [[nodiscard]] std::uint64_t revision() const { return revision_; }

 private:
  PoseGraph graph_;
  std::uint64_t revision_;
  OptimisationSummary summary_;
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

  /// Adds a keyframe, looks for closures, optimises around those it found. Never throws for bad
  /// data.
  InsertionResult insert(Keyframe keyframe);

  /// Optimises the whole graph.
  void optimize();

  /// Whether closures came in that only a window around them knows of, and the map has grown
  /// enough since the last time to be worth an optimisation as a whole.
  [[nodiscard]] bool optimisationDue() const;
  /// A copy of the graph to be optimised while keyframes go on coming in.
  [[nodiscard]] GraphOptimisation startOptimisation();
  /// Takes over the result, then optimises around the closures it could not know of. Does nothing
  /// when the map was reset or optimised as a whole meanwhile.
  void finishOptimisation(const GraphOptimisation& optimisation);

  /// Forgets everything.
  void reset();

  [[nodiscard]] std::shared_ptr<const MapSnapshot> snapshot() const;
  [[nodiscard]] BackendStatistics statistics() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/backend_node/backend.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <optional>
#include <utility>

#include "planecloud_slam/backend_node/closure_consistency.h"
#include "planecloud_slam/backend_node/closure_verifier.h"
#include "planecloud_slam/backend_node/coplanarity_detector.h"
#include "planecloud_slam/backend_node/drift_model.h"
#include "planecloud_slam/backend_node/join_check.h"
#include "planecloud_slam/backend_node/keyframe_check.h"
#include "planecloud_slam/backend_node/keyframe_map.h"
#include "planecloud_slam/backend_node/loop_closure_detector.h"
#include "planecloud_slam/backend_node/plane_set_cache.h"
#include "planecloud_slam/backend_node/rejected_closures.h"
#include "planecloud_slam/backend_node/session_ledger.h"

namespace planecloud {
namespace {

/// Keyframes kept prepared for alignment, at a few hundred kilobytes each.
constexpr std::size_t kPreparedKeyframes = 24;

/// Of the map: how much it grows before it is worth to optimise it as a whole again.
constexpr double kLeastGrowth = 0.02;

BackendOptions checked(BackendOptions options) {
  options.check();
  return options;
}

}  // namespace

class Backend::Impl {
 public:
  explicit Impl(const BackendOptions& options)
      : options_(checked(options)),
        map_(options_.graph, options_.map),
        detector_(options_.loop_closure.candidates, options_.loop_closure.drift),
        verifier_(options_.loop_closure.verification, options_.icap),
        consistency_(options_.loop_closure.consistency, options_.loop_closure.drift),
        join_check_(options_.loop_closure.consistency, options_.icap),
        coplanarity_(options_.loop_closure, options_.icap),
        plane_sets_(options_.icap.planes, kPreparedKeyframes) {}

  InsertionResult insert(Keyframe keyframe) {
    InsertionResult result;
    if (map_.graph().find(keyframe.id)) {
      result.status = InsertionStatus::kDuplicate;
      result.reason = "keyframe " + toString(keyframe.id) + " is in the map already: ignored";
      return result;
    }
    KeyframeCheck check = checkKeyframe(keyframe);
    result.reason = check.reason;
    if (!check.planes) return result;
    result.reason = sessions_.clash(keyframe);
    if (!result.reason.empty()) {
      result.status = InsertionStatus::kNameClash;
      return result;
    }
    sessions_.record(keyframe);
    const int node = map_.add(std::move(keyframe), *check.planes);
    result.status = InsertionStatus::kInserted;
    changed();
    ++added_;
    if (options_.loop_closure.candidates.enabled) closeLoops(node, result);
    if (!result.closures.empty()) {
      optimizeAround(result.closures);
      result.optimised = true;
      if (under_way_) {
        under_way_->closures.insert(under_way_->closures.end(), result.closures.begin(),
                                    result.closures.end());
      }
    }
    if (options_.loop_closure.coplanarity.enabled) findCoplanar(node, *check.planes);
    return result;
  }

  void optimize() {
    countRemoved(map_.graph().optimize().removed);
    optimised();
    under_way_.reset();
  }

  [[nodiscard]] bool optimisationDue() const {
    return !settled_ && static_cast<double>(added_) >= kLeastGrowth * map_.graph().size();
  }

  [[nodiscard]] GraphOptimisation startOptimisation() {
    optimised();
    under_way_ = UnderWay{revision_, {}};
    return GraphOptimisation(map_.graph(), revision_);
  }

  void finishOptimisation(const GraphOptimisation& optimisation) {
    if (!under_way_ || under_way_->revision != optimisation.revision()) return;
    const std::vector<GraphEdge> since = std::move(under_way_->closures);
    under_way_.reset();
    countRemoved(map_.graph().adopt(optimisation.graph(), optimisation.summary()));
    changed();
    if (!since.empty()) optimizeAround(since);
  }

  void reset() {
    const std::uint64_t revision = revision_;
    *this = Impl(options_);
    revision_ = revision + 1;
  }

  [[nodiscard]] std::shared_ptr<const MapSnapshot> snapshot() {
    if (!snapshot_) {
      MapSnapshot snapshot = map_.snapshot();
      snapshot.revision = revision_;
      snapshot.rejected = rejected_.newest();
      snapshot_ = std::make_shared<const MapSnapshot>(std::move(snapshot));
    }
    return snapshot_;
  }

  [[nodiscard]] BackendStatistics statistics() const {
    BackendStatistics statistics;
    statistics.keyframes = static_cast<std::size_t>(map_.graph().size());
    statistics.components = map_.graph().components();
    statistics.rejected = rejected_.counts();
    statistics.closures_intra = map_.graph().closures(false);
    statistics.closures_inter = map_.graph().closures(true);
    statistics.coplanar_edges = map_.graph().coplanarEdges();
    return statistics;
  }

 private:
  /// An optimisation of the whole that was started and not yet taken over.
  struct UnderWay {
    std::uint64_t revision = 0;       ///< of the map it began with
    std::vector<GraphEdge> closures;  ///< accepted since
  };

  /// A small map is optimised as a whole, which is what its window would be.
  void optimizeAround(const std::vector<GraphEdge>& closures) {
    if (map_.graph().size() <= options_.graph.local_window) return optimize();
    std::vector<int> ends;
    for (const GraphEdge& closure : closures) {
      ends.push_back(map_.graph().find(closure.to).value());
      ends.push_back(map_.graph().find(closure.from).value());
    }
    map_.graph().optimizeAround(ends);
    settled_ = false;
    changed();
  }

  void countRemoved(const std::vector<GraphEdge>& removed) {
    for (const GraphEdge& edge : removed) {
      if (edge.kind == EdgeKind::kClosure) rejected_.add({edge.from, edge.to, "found_false_later"});
    }
  }

  /// Each of these edges tells too little to be worth an optimisation of its own.
  void findCoplanar(int node, const PlaneCloud& planes) {
    for (const GraphEdge& edge : coplanarity_.detect(map_.graph(), map_.records(), node, planes)) {
      map_.graph().addEdge(edge);
      settled_ = false;
    }
  }

  /// All that is known so far is in an optimisation of the whole.
  void optimised() {
    settled_ = true;
    added_ = 0;
    changed();
  }

  void changed() {
    ++revision_;
    snapshot_.reset();
  }

  void closeLoops(int node, InsertionResult& result) {
    for (const LoopCandidate& candidate : detector_.detect(map_.graph(), map_.records(), node)) {
      const ClosureCheck check = verify(candidate);
      if (check.verdict != ClosureVerdict::kAccepted) {
        rejected_.add({map_.graph().id(candidate.target), map_.graph().id(candidate.source),
                       toString(check.verdict)});
        ++result.rejected_closures;
        continue;
      }
      admit(makeClosure(candidate, check.alignment), result);
    }
  }

  [[nodiscard]] ClosureCheck verify(const LoopCandidate& candidate) {
    RelativePoseGuess guess;
    if (candidate.located) {
      guess.T_target_source =
          map_.graph().pose(candidate.target).inverse() * map_.graph().pose(candidate.source);
      guess.covariance =
          driftCovariance(std::min(candidate.path, 1e3), options_.loop_closure.drift);
    } else {
      guess.T_target_source = Eigen::AngleAxisd(candidate.turn, Eigen::Vector3d::UnitY());
    }
    return verifier_.verify(plane_sets_.get(map_.records(), candidate.target),
                            plane_sets_.get(map_.records(), candidate.source), guess);
  }

  [[nodiscard]] GraphEdge makeClosure(const LoopCandidate& candidate,
                                      const IcapResult& alignment) const {
    GraphEdge closure;
    closure.kind = EdgeKind::kClosure;
    closure.from = map_.graph().id(candidate.target);
    closure.to = map_.graph().id(candidate.source);
    closure.T_from_to = alignment.T_target_source;
    closure.information = alignment.information;
    closure.inter_robot = closure.from.robot != closure.to.robot;
    return closure;
  }

  void admit(const GraphEdge& closure, InsertionResult& result) {
    const auto holds = [this](const ComponentJoin& join, const std::vector<GraphEdge>& closures) {
      return join_check_.holds(map_.graph(), map_.records(), join, closures, plane_sets_);
    };
    ClosureAdmission admission = consistency_.offer(map_.graph(), closure, holds);
    if (admission.join) {
      map_.graph().moveComponent(admission.join->source, admission.join->T_target_source);
    }
    for (GraphEdge& accepted : admission.closures) {
      map_.graph().addEdge(accepted);
      result.closures.push_back(std::move(accepted));
    }
    rejected_.add(admission.rejected, "inconsistent_with_closures");
    rejected_.add(admission.expired, "no_witness");
    result.rejected_closures +=
        static_cast<int>(admission.rejected.size() + admission.expired.size());
  }

  BackendOptions options_;
  KeyframeMap map_;
  SessionLedger sessions_;
  LoopClosureDetector detector_;
  ClosureVerifier verifier_;
  ClosureConsistency consistency_;
  JoinCheck join_check_;
  CoplanarityDetector coplanarity_;
  PlaneSetCache plane_sets_;
  RejectedClosures rejected_;
  bool settled_ = true;    ///< no closures wait for an optimisation of the whole
  std::size_t added_ = 0;  ///< keyframes since the last optimisation of the whole
  std::optional<UnderWay> under_way_;
  std::uint64_t revision_ = 0;
  std::shared_ptr<const MapSnapshot> snapshot_;  ///< of `revision_`, null until asked for
};

Backend::Backend(const BackendOptions& options) : impl_(std::make_unique<Impl>(options)) {}
Backend::~Backend() = default;
Backend::Backend(Backend&&) noexcept = default;
Backend& Backend::operator=(Backend&&) noexcept = default;

InsertionResult Backend::insert(Keyframe keyframe) { return impl_->insert(std::move(keyframe)); }
void Backend::optimize() { impl_->optimize(); }
bool Backend::optimisationDue() const { return impl_->optimisationDue(); }
GraphOptimisation Backend::startOptimisation() { return impl_->startOptimisation(); }
void Backend::finishOptimisation(const GraphOptimisation& optimisation) {
  impl_->finishOptimisation(optimisation);
}
void Backend::reset() { impl_->reset(); }
std::shared_ptr<const MapSnapshot> Backend::snapshot() const { return impl_->snapshot(); }
BackendStatistics Backend::statistics() const { return impl_->statistics(); }

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/backend_node/backend_options.h"

#include <stdexcept>

namespace planecloud {

std::string toString(RobustKernel kernel) {
  switch (kernel) {
    case RobustKernel::kNone:
      return "none";
    case RobustKernel::kHuber:
      return "huber";
    case RobustKernel::kCauchy:
      return "cauchy";
    case RobustKernel::kDcs:
      return "dcs";
  }
  throw std::invalid_argument("not a robust kernel: use none, huber, cauchy or dcs");
}

void fromString(const std::string& text, RobustKernel& kernel) {
  for (const RobustKernel k :
       {RobustKernel::kNone, RobustKernel::kHuber, RobustKernel::kCauchy, RobustKernel::kDcs}) {
    if (toString(k) != text) continue;
    kernel = k;
    return;
  }
  throw std::invalid_argument("\"" + text + "\": must be one of none, huber, cauchy, dcs");
}

void LoopCandidateOptions::check() const {
  checkRange("loop_closure/search_radius", search_radius, 0.1, 20.0);
  checkRange("loop_closure/max_search_radius", max_search_radius, 0.1, 50.0);
  checkRange("loop_closure/max_view_angle", max_view_angle, 1e-3, 3.2);
  checkRange("loop_closure/min_view_overlap", min_view_overlap, 0.0, 1.0);
  checkRange("loop_closure/min_path_gap", min_path_gap, 0.0, 100.0);
  checkRange("loop_closure/max_spatial", max_spatial, 0, 100);
  checkRange("loop_closure/max_appearance", max_appearance, 0, 100);
  checkRange("loop_closure/max_dissimilarity", max_dissimilarity, 0.0, 1.0);
}

void DriftOptions::check() const {
  checkRange("loop_closure/drift/translation_drift", translation_drift, 0.0, 1.0);
  checkRange("loop_closure/drift/rotation_drift", rotation_drift, 0.0, 1.0);
  checkRange("loop_closure/drift/translation_base", translation_base, 1e-4, 1.0);
  checkRange("loop_closure/drift/rotation_base", rotation_base, 1e-4, 1.0);
}

void ClosureVerificationOptions::check() const {
  checkRange("loop_closure/verification/min_overlap", min_overlap, 0.0, 1.0);
  checkRange("loop_closure/verification/min_view", min_view, 0.0, 1.0);
  checkRange("loop_closure/verification/max_residual", max_residual, 1e-4, 1.0);
  checkRange("loop_closure/verification/max_seen_through", max_seen_through, 0.0, 1.0);
  checkRange("loop_closure/verification/max_inconsistency", max_inconsistency, 1e-3, 1e3);
  checkRange("loop_closure/verification/ambiguity_margin", ambiguity_margin, 0.0, 1.0);
  checkRange("loop_closure/verification/unlocated_min_overlap", unlocated_min_overlap, 0.0, 1.0);
  checkRange("loop_closure/verification/unlocated_max_seen_through", unlocated_max_seen_through,
             0.0, 1.0);
}

void ClosureConsistencyOptions::check() const {
  checkRange("loop_closure/consistency/min_intra", min_intra, 1, 20);
  checkRange("loop_closure/consistency/min_inter", min_inter, 1, 20);
  checkRange("loop_closure/consistency/max_distance", max_distance, 1e-3, 1e3);
  checkRange("loop_closure/consistency/max_path", max_path, 0.0, 1e3);
  checkRange("loop_closure/consistency/join_translation", join_translation, 1e-4, 10.0);
  checkRange("loop_closure/consistency/join_rotation", join_rotation, 1e-4, 1.0);
  checkRange("loop_closure/consistency/join_check_path", join_check_path, 0.0, 100.0);
  checkRange("loop_closure/consistency/join_seen_through", join_seen_through, 0.0, 1.0);
  checkRange("loop_closure/consistency/max_pending", max_pending, 1, 100000);
}

void CoplanarityOptions::check() const {
  checkRange("loop_closure/coplanarity/min_area", min_area, 0.1, 100.0);
  checkRange("loop_closure/coplanarity/max_distance", max_distance, 0.5, 50.0);
  checkRange("loop_closure/coplanarity/max_path", max_path, 0.0, 1e3);
  checkRange("loop_closure/coplanarity/max_edges", max_edges, 1, 10);
  checkRange("loop_closure/coplanarity/max_inconsistency", max_inconsistency, 1e-3, 1e3);
}

void LoopClosureOptions::check() const {
  candidates.check();
  drift.check();
  verification.check();
  consistency.check();
  coplanarity.check();
}

void PoseGraphOptions::check() const {
  checkRange("graph/kernel_width", kernel_width, 1e-3, 100.0);
  checkRange("graph/max_iterations", max_iterations, 1, 1000);
  checkRange("graph/local_window", local_window, 10, 100000);
  checkRange("graph/threads", threads, 1, 256);
  checkRange("graph/odometry_translation_floor", odometry_translation_floor, 0.0, 1.0);
  checkRange("graph/odometry_rotation_floor", odometry_rotation_floor, 0.0, 1.0);
  checkRange("graph/removal_distance", removal_distance, 1e-3, 1e6);
}

void MapFrameOptions::check() const {
  checkRange("map/level_keyframes", level_keyframes, 1, 1000);
  checkRange("map/max_floor_tilt", max_floor_tilt, 0.0, 1.5);
}

void BackendOptions::check() const {
  icap.check();
  loop_closure.check();
  graph.check();
  map.check();
}

}  // namespace planecloud

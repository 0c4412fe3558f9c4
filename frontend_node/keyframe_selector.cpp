// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/frontend_node/keyframe_selector.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

namespace planecloud {

void KeyframeSelectorOptions::check() const {
  checkRange("keyframe/max_translation", max_translation, 0.01, 10.0);
  checkRange("keyframe/max_rotation", max_rotation, 0.01, 3.0);
  checkRange("keyframe/min_entropy_ratio", min_entropy_ratio, 0.0, 1.0);
  checkRange("keyframe/min_overlap", min_overlap, 0.0, 1.0);
}

double poseEntropy(const Matrix6d& information) {
  const Eigen::LDLT<Matrix6d> ldlt(information);
  const Vector6d pivots = ldlt.vectorD();
  if (ldlt.info() != Eigen::Success || !(pivots.minCoeff() > 0.0)) {
    return std::numeric_limits<double>::infinity();
  }
  return 3.0 * (1.0 + std::log(2.0 * M_PI)) - 0.5 * pivots.array().log().sum();
}

KeyframeSelector::KeyframeSelector(const KeyframeSelectorOptions& options) : options_(options) {
  options_.check();
}

void KeyframeSelector::setOptions(const KeyframeSelectorOptions& options) {
  options.check();
  options_ = options;
}

void KeyframeSelector::reset() {
  has_first_entropy_ = false;
  entropy_ratio_ = 1.0;
}

bool KeyframeSelector::isLeavingKeyframe(const Eigen::Isometry3d& T_keyframe_camera,
                                         const Matrix6d& information, double overlap) {
  const double entropy = poseEntropy(information);
  if (!has_first_entropy_) {
    first_entropy_ = entropy;
    has_first_entropy_ = true;
  }
  // Both entropies are negative for any useful track: growing uncertainty shrinks the ratio. When
  // the first one tells nothing, neither does the ratio.
  entropy_ratio_ = first_entropy_ < 0.0 ? entropy / first_entropy_ : 1.0;
  return T_keyframe_camera.translation().norm() > options_.max_translation ||
         rotationAngle(T_keyframe_camera) > options_.max_rotation ||
         overlap < options_.min_overlap || entropy_ratio_ < options_.min_entropy_ratio;
}

}  // namespace planecloud

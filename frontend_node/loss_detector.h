// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "planecloud_slam/frontend_node/dense_tracker.h"
#include "planecloud_slam/frontend_node/frontend.h"
#include "planecloud_slam/frontend_node/loss_options.h"

namespace planecloud {

/// What a track must explain besides its alignment.
struct TrackedMotion {
  double entropy_ratio = 1.0;  ///< see `KeyframeSelector::entropyRatio`
  Eigen::Isometry3d T_previous_current = Eigen::Isometry3d::Identity();  ///< since the last good
  double seconds = 0.0;                                                  ///< since the last good
  /// The same motion as the wheels report it.
  std::optional<Eigen::Isometry3d> T_previous_current_wheels;
};

/// Says why a frame or its alignment cannot be trusted. Learns from the frames that can be what
/// their residuals normally are: exposure, texture and noise decide that, not a fixed limit.
class LossDetector {
 public:
  /// Throws std::invalid_argument when `options` fail their check.
  explicit LossDetector(const LossOptions& options);

  /// Why the image pair is useless; empty when it is not.
  [[nodiscard]] std::string findImageFault(const RgbdFrame& frame) const;

  /// Why the alignment is not to be believed; empty when it is.
  [[nodiscard]] std::string findAlignmentFault(const Alignment& alignment,
                                               const TrackedMotion& motion) const;

  /// Why the alignment is not enough to go on with after a loss, when nothing else is known of the
  /// motion; empty when it is. `is_lenient` allows for one view being much nearer than the other,
  /// which shows what the other cannot.
  [[nodiscard]] std::string findDoubt(const Alignment& alignment, bool is_lenient = false) const;

  /// Much in the view is not what the keyframe shows there, so somebody may stand before it:
  /// nothing to learn from, nor to make a keyframe of, which would be tracked by who walks away.
  /// `is_wary`: anything out of the ordinary counts.
  [[nodiscard]] bool isObstructed(const Alignment& alignment, bool is_wary = false) const;

  /// The view is what the keyframe shows there, as usual: nobody in it would be taken for a place.
  [[nodiscard]] bool isOrdinary(const Alignment& alignment) const;

  /// A good frame was aligned so.
  void learn(const Alignment& alignment);
  /// What is normal is to be learnt anew, in another recording.
  void forget() { normal_grey_ = normal_inliers_ = 0.0; }

 private:
  /// Largest scale of the grey residuals to believe, `growth` times the normal one.
  [[nodiscard]] double greyLimit(double growth) const;
  [[nodiscard]] std::string findWeakness(const Alignment& alignment) const;
  [[nodiscard]] std::string findUncertainty(const Alignment& alignment) const;
  [[nodiscard]] std::string findImplausibleMotion(const TrackedMotion& motion) const;

  LossOptions options_;
  double normal_grey_ = 0.0;     ///< scale of the grey residuals of good frames; 0: not known
  double normal_inliers_ = 0.0;  ///< share of good frames
};

}  // namespace planecloud

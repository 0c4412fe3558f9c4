// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include "planecloud_slam/plane_fit/option_fields.h"
#include "planecloud_slam/plane_fit/se3.h"

namespace planecloud {

/// When a new keyframe opens; each criterion alone suffices.
struct KeyframeSelectorOptions {
  double max_translation = 0.25;    ///< from the keyframe [m], [0.01, 10]
  double max_rotation = 0.26;       ///< from the keyframe [rad], [0.01, 3]
  double min_entropy_ratio = 0.85;  ///< of Kerl 2013b sec. IV-B, [0, 1]; 0: never by entropy
  /// Share of the keyframe's points still in view, [0, 1]; 0: never by overlap. Near scenes leave
  /// the view after a shorter way than far ones.
  double min_overlap = 0.0;

  template <typename Self, typename Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("max_translation", self.max_translation);
    visit("max_rotation", self.max_rotation);
    visit("min_entropy_ratio", self.min_entropy_ratio);
    visit("min_overlap", self.min_overlap);
  }

  /// Throws std::invalid_argument naming key, value and range.
  void check() const;
};

/// Differential entropy of a pose estimate, `3 (1 + ln 2 pi) + 0.5 ln |Sigma|` with Sigma the
/// inverse of `information` (Kerl 2013b eq. (11)). Infinite when the information is singular.
[[nodiscard]] double poseEntropy(const Matrix6d& information);

/// Decides when the view has left the keyframe (paper sec. 3.1, Kerl 2013b sec. IV-B).
class KeyframeSelector {
 public:
  /// Throws std::invalid_argument when `options` fail their check.
  explicit KeyframeSelector(const KeyframeSelectorOptions& options);

  /// Goes on with other thresholds. Throws, and changes nothing, when they fail their check.
  void setOptions(const KeyframeSelectorOptions& options);

  /// A new keyframe was opened: its first tracked frame will set the reference entropy.
  void reset();

  /// True when the frame at `T_keyframe_camera`, aligned to the keyframe with `information` and
  /// with this share of its points in view, should become the next keyframe.
  [[nodiscard]] bool isLeavingKeyframe(const Eigen::Isometry3d& T_keyframe_camera,
                                       const Matrix6d& information, double overlap);

  /// Entropy of the last frame over that of the first one after the keyframe; 1 at first.
  [[nodiscard]] double entropyRatio() const { return entropy_ratio_; }

 private:
  KeyframeSelectorOptions options_;
  bool has_first_entropy_ = false;
  double first_entropy_ = 0.0;
  double entropy_ratio_ = 1.0;
};

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "planecloud_slam/frontend_node/dense_tracker.h"
#include "planecloud_slam/frontend_node/frontend.h"
#include "planecloud_slam/frontend_node/keyframe_selector.h"
#include "planecloud_slam/frontend_node/last_good_image.h"
#include "planecloud_slam/frontend_node/live_images.h"
#include "planecloud_slam/frontend_node/loss_detector.h"
#include "planecloud_slam/frontend_node/motion_model.h"
#include "planecloud_slam/frontend_node/open_keyframe.h"
#include "planecloud_slam/frontend_node/relocaliser.h"
#include "planecloud_slam/frontend_node/wheel_path.h"

namespace planecloud {

/// Tracking in one camera: which keyframe frames are aligned to, when the next
/// one opens, and what happens when the track is lost.
class TrackingSession {
 public:
  /// `camera` as it takes the images. Throws std::invalid_argument when options or camera fail
  /// their check.
  TrackingSession(const FrontendOptions& options, const CameraIntrinsics& camera,
                  KeyframeId first_id, int first_segment = 0);

  /// See Frontend::track; stamps must not run backwards.
  [[nodiscard]] FrameResult track(const RgbdFrame& frame,
                                  const std::optional<Eigen::Isometry3d>& T_previous_current);

  /// Completes the open keyframe; the next frame opens a segment where this one ended.
  void endSegment();
  /// Nothing seen so far will be looked for again: time went backwards.
  void forgetHistory() {
    history_.clear();
    loss_.forget();
    wary_until_ = 0.0;
  }
  void setNextPose(const Eigen::Isometry3d& T_odom_camera) { T_odom_start_ = T_odom_camera; }
  void setKeyframeOptions(const KeyframeSelectorOptions& options) { selector_.setOptions(options); }
  [[nodiscard]] std::vector<CompletedKeyframe> takeCompleted();

  [[nodiscard]] bool isTracking() const { return static_cast<bool>(reference_.view); }
  [[nodiscard]] const KeyframeId& nextId() const { return next_id_; }
  [[nodiscard]] const Eigen::Isometry3d& nextPose() const { return T_odom_start_; }
  [[nodiscard]] int nextSegment() const { return next_segment_; }

 private:
  void predictMotion(double stamp, const std::optional<Eigen::Isometry3d>& T_previous_current);
  [[nodiscard]] Eigen::Isometry3d motionToDepth(const RgbdFrame& frame) const;
  [[nodiscard]] FrameResult process(const RgbdFrame& frame);
  [[nodiscard]] FrameResult accept(const RgbdFrame& frame, const Alignment& alignment,
                                   bool leaving);
  [[nodiscard]] FrameResult recover(const RgbdFrame& frame, const std::string& fault);
  [[nodiscard]] std::vector<ExpectedPlace> expectedPlaces(double stamp);
  [[nodiscard]] FrameResult resume(const RgbdFrame& frame, const Relocalisation& found);
  [[nodiscard]] FrameResult lose(const std::string& reason);
  [[nodiscard]] FrameResult bridgeByWheels(const RgbdFrame& frame);
  [[nodiscard]] FrameResult openSegment(const RgbdFrame& frame);
  [[nodiscard]] TrackedMotion motionOf(const Alignment& alignment, double stamp) const;
  [[nodiscard]] std::vector<EarlierImage> earlierImages(
      const Eigen::Isometry3d& T_odom_camera) const;
  void switchTo(const Relocalisation& found);
  void restrictToFloor();
  void openKeyframe(const RgbdFrame& frame, const Eigen::Isometry3d& T_odom_camera,
                    std::vector<RelativePoseEdge> edges);
  void completeKeyframe();
  [[nodiscard]] bool isLost() const { return last_stamp_ > last_good_stamp_; }

  const FrontendOptions options_;
  LiveImages images_;
  DenseTracker tracker_;
  KeyframeSelector selector_;
  LossDetector loss_;
  Relocaliser relocaliser_;
  OpenKeyframe open_;
  std::optional<PlaneLandmarks> landmarks_;
  std::optional<PlanarMotion> planar_;  ///< of this segment, when motion is restricted to it

  TrackedReference reference_;  ///< what frames are aligned to; no view: none
  LastGoodImage last_good_;
  std::deque<KeyframeViewPtr> history_;
  KeyframeId next_id_;
  int segment_ = -1;  ///< of the reference; goes back when an earlier one is found again
  int next_segment_ = 0;
  std::vector<CompletedKeyframe> completed_;

  Eigen::Isometry3d T_odom_start_;  ///< where the next segment begins
  Eigen::Isometry3d T_reference_last_ = Eigen::Isometry3d::Identity();       ///< last good frame
  Eigen::Isometry3d T_reference_predicted_ = Eigen::Isometry3d::Identity();  ///< this frame
  MotionModel motion_;
  Brightness brightness_;
  double last_stamp_ = 0.0;
  double last_good_stamp_ = 0.0;
  double wary_until_ = 0.0;
  double usable_lost_ = 0.0;  ///< time lost on usable images [s]
  bool last_was_usable_ = false;
  WheelPath wheels_;                ///< since T_reference_last_
  bool wheels_since_good_ = false;  ///< the wheels spoke ever since the last good frame
};

}  // namespace planecloud

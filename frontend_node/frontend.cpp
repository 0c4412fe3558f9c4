// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/frontend_node/frontend.h"

#include <stdexcept>
#include <utility>

#include "planecloud_slam/frontend_node/dense_tracker.h"
#include "planecloud_slam/frontend_node/keyframe_selector.h"
#include "planecloud_slam/frontend_node/local_map.h"
#include "planecloud_slam/frontend_node/loss_detector.h"
#include "planecloud_slam/frontend_node/rectifier.h"
#include "planecloud_slam/frontend_node/rgbd_pyramid.h"
#include "planecloud_slam/frontend_node/tracking_reference.h"

namespace planecloud {
namespace {

/// A level camera looking along x of the odometry frame (x forward, y left, z up).
Eigen::Isometry3d levelledCamera() {
  Eigen::Isometry3d T_odom_camera = Eigen::Isometry3d::Identity();
  T_odom_camera.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return T_odom_camera;
}

const FrontendOptions& checked(const FrontendOptions& options) {
  options.check();
  return options;
}

CameraIntrinsics trackedCamera(const CameraIntrinsics& camera) {
  camera.check();
  return camera.rectified();
}

void checkSize(int width, int height, const CameraIntrinsics& camera, const char* image) {
  if (width == camera.width && height == camera.height) return;
  throw std::invalid_argument(
      std::string("the ") + image + " image is " + std::to_string(width) + " x " +
      std::to_string(height) + " but the camera is " + std::to_string(camera.width) + " x " +
      std::to_string(camera.height) +
      ": use depth registered to colour and the camera info of these images");
}

}  // namespace

class Frontend::Impl {
 public:
  Impl(const FrontendOptions& options, const CameraIntrinsics& camera, std::string robot,
       std::uint64_t session)
      : options_(checked(options)),
        camera_(trackedCamera(camera)),
        pyramid_(camera_, options.tracking),
        tracker_(options.tracking),
        selector_(options.keyframe),
        loss_(options.lost),
        local_map_(options.local_map, camera_),
        T_odom_start_(levelledCamera()) {
    if (robot.empty()) throw std::invalid_argument("a frontend needs the name of its robot");
    if (options.undistort && camera.hasDistortion()) rectifier_.emplace(camera);
    next_id_ = {std::move(robot), session, 0};
  }

  FrameResult track(const RgbdFrame& raw,
                    const std::optional<Eigen::Isometry3d>& T_previous_current) {
    checkSize(raw.grey.width(), raw.grey.height(), camera_, "colour");
    checkSize(raw.depth.width(), raw.depth.height(), camera_, "depth");
    if (!raw.color.empty()) checkSize(raw.color.width(), raw.color.height(), camera_, "texture's");
    if (reference_ && raw.stamp < last_stamp_) endSegment();
    RgbdFrame rectified;
    if (rectifier_) rectified = rectifier_->rectify(raw);
    const RgbdFrame& frame = rectifier_ ? rectified : raw;

    predictMotion(frame.stamp, T_previous_current);
    FrameResult result = process(frame);
    result.stamp = frame.stamp;
    last_stamp_ = frame.stamp;
    return result;
  }

  std::vector<CompletedKeyframe> takeCompleted() { return std::exchange(completed_, {}); }

  void endSegment() {
    if (!reference_) return;
    completeKeyframe();
    reference_.reset();
    T_odom_start_ = T_odom_reference_ * T_reference_last_;
    velocity_.reset();
  }

  void setNextPose(const Eigen::Isometry3d& T_odom_camera) { T_odom_start_ = T_odom_camera; }

  std::unique_ptr<Impl> continueWith(const CameraIntrinsics& camera) {
    auto next = std::make_unique<Impl>(options_, camera, next_id_.robot, next_id_.session);
    endSegment();
    next->next_id_ = next_id_;
    next->completed_ = std::move(completed_);
    next->T_odom_start_ = T_odom_start_;
    return next;
  }

 private:
  /// Where the frame at `stamp` should be, from wheel odometry, else at constant velocity.
  void predictMotion(double stamp, const std::optional<Eigen::Isometry3d>& T_previous_current) {
    if (!reference_) return;
    if (T_previous_current) {
      T_reference_predicted_ = T_reference_predicted_ * *T_previous_current;
    } else if (velocity_ && !lost()) {
      T_reference_predicted_ = T_reference_last_ * expSe3(*velocity_ * (stamp - last_stamp_));
    }
  }

  FrameResult process(const RgbdFrame& frame) {
    const std::string image_fault = loss_.findImageFault(frame);
    if (!image_fault.empty()) return lose(image_fault);
    pyramid_.assign(frame.grey.view(), frame.depth.view());
    if (!reference_) return openSegment(frame);

    const Alignment alignment = tracker_.align(
        *reference_, pyramid_, {{T_reference_predicted_, T_reference_last_}, brightness_});
    const bool leaving =
        selector_.isLeavingKeyframe(alignment.T_reference_current, alignment.normal_matrix);
    const std::string fault = loss_.findAlignmentFault(alignment, motionOf(alignment, frame));
    if (fault.empty()) return accept(frame, alignment, leaving);
    if (frame.stamp - last_good_stamp_ < options_.lost.new_segment_after) return lose(fault);
    endSegment();
    return openSegment(frame);
  }

  [[nodiscard]] TrackedMotion motionOf(const Alignment& alignment, const RgbdFrame& frame) const {
    return {selector_.entropyRatio(), T_reference_last_.inverse() * alignment.T_reference_current,
            frame.stamp - last_good_stamp_};
  }

  [[nodiscard]] bool lost() const { return last_stamp_ > last_good_stamp_; }

  /// The pose stays where it was last known.
  FrameResult lose(const std::string& reason) {
    FrameResult result;
    result.status = TrackingStatus::kLost;
    result.reason = reason;
    result.T_odom_camera = reference_ ? T_odom_reference_ * T_reference_last_ : T_odom_start_;
    if (reference_) {
      result.reference = keyframe_.id;
      result.T_reference_camera = T_reference_last_;
    }
    velocity_.reset();
    return result;
  }

  FrameResult accept(const RgbdFrame& frame, const Alignment& alignment, bool leaving) {
    const Eigen::Isometry3d& T_reference_camera = alignment.T_reference_current;
    const double seconds = frame.stamp - last_good_stamp_;
    if (seconds > 0.0) {
      velocity_ = logSe3(T_reference_last_.inverse() * T_reference_camera) / seconds;
    }
    T_reference_last_ = T_reference_predicted_ = T_reference_camera;
    brightness_ = alignment.brightness;
    last_good_stamp_ = frame.stamp;

    FrameResult result;
    result.status = TrackingStatus::kTracked;
    result.T_odom_camera = T_odom_reference_ * T_reference_camera;
    result.reference = keyframe_.id;
    result.T_reference_camera = T_reference_camera;
    result.information = alignment.information;
    if (leaving) {
      completeKeyframe();
      openKeyframe(frame, result.T_odom_camera);
      keyframe_.edges = {{result.reference, T_reference_camera, result.information}};
    } else {
      local_map_.fuse(frame.depth.view(), T_reference_camera);
    }
    return result;
  }

  FrameResult openSegment(const RgbdFrame& frame) {
    openKeyframe(frame, T_odom_start_);
    last_good_stamp_ = frame.stamp;
    FrameResult result;
    result.status = TrackingStatus::kInitialised;
    result.T_odom_camera = T_odom_start_;
    result.reference = keyframe_.id;
    return result;
  }

  void openKeyframe(const RgbdFrame& frame, const Eigen::Isometry3d& T_odom_camera) {
    keyframe_ = Keyframe{};
    keyframe_.id = next_id_;
    ++next_id_.number;
    keyframe_.stamp = frame.stamp;
    keyframe_.T_odom_camera = T_odom_reference_ = T_odom_camera;
    keyframe_grey_ = frame.grey;
    keyframe_color_ = frame.color;
    reference_.emplace(pyramid_, options_.tracking);
    local_map_.open(frame.depth.view());
    selector_.reset();
    brightness_ = Brightness{};
    T_reference_last_ = T_reference_predicted_ = Eigen::Isometry3d::Identity();
  }

  void completeKeyframe() {
    completed_.push_back({std::move(keyframe_), local_map_.depth(), std::move(keyframe_grey_),
                          camera_, std::move(keyframe_color_)});
  }

  const FrontendOptions options_;
  const CameraIntrinsics camera_;  ///< without distortion
  std::optional<Rectifier> rectifier_;
  RgbdPyramid pyramid_;
  DenseTracker tracker_;
  KeyframeSelector selector_;
  LossDetector loss_;
  LocalMap local_map_;

  std::optional<TrackingReference> reference_;  ///< of the open keyframe
  Keyframe keyframe_;                           ///< the open one
  Image<std::uint8_t> keyframe_grey_;
  Image<Rgb8> keyframe_color_;
  KeyframeId next_id_;
  std::vector<CompletedKeyframe> completed_;

  Eigen::Isometry3d T_odom_start_;  ///< where the next segment begins
  Eigen::Isometry3d T_odom_reference_ = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d T_reference_last_ = Eigen::Isometry3d::Identity();       ///< last good frame
  Eigen::Isometry3d T_reference_predicted_ = Eigen::Isometry3d::Identity();  ///< this frame
  std::optional<Vector6d> velocity_;                                         ///< [m/s, rad/s]
  Brightness brightness_;
  double last_stamp_ = 0.0;
  double last_good_stamp_ = 0.0;
};

Frontend::Frontend(const FrontendOptions& options, const CameraIntrinsics& camera,
                   std::string robot, std::uint64_t session)
    : impl_(std::make_unique<Impl>(options, camera, std::move(robot), session)) {}
Frontend::~Frontend() = default;
Frontend::Frontend(Frontend&&) noexcept = default;
Frontend& Frontend::operator=(Frontend&&) noexcept = default;

FrameResult Frontend::track(const RgbdFrame& frame,
                            const std::optional<Eigen::Isometry3d>& T_previous_current) {
  return impl_->track(frame, T_previous_current);
}

std::vector<CompletedKeyframe> Frontend::takeCompleted() { return impl_->takeCompleted(); }

void Frontend::finish() { impl_->endSegment(); }

void Frontend::startNewSegment() { impl_->endSegment(); }

void Frontend::changeCamera(const CameraIntrinsics& camera) { impl_ = impl_->continueWith(camera); }

void Frontend::setNextPose(const Eigen::Isometry3d& T_odom_camera) {
  impl_->setNextPose(T_odom_camera);
}

}  // namespace planecloud

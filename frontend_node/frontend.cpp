// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/frontend_node/frontend.h"

#include <stdexcept>
#include <utility>

#include "planecloud_slam/frontend_node/tracking_session.h"

namespace planecloud {
namespace {

const FrontendOptions& checked(const FrontendOptions& options) {
  options.check();
  return options;
}

CameraIntrinsics trackedCamera(const CameraIntrinsics& camera, const FrontendOptions& options) {
  camera.check();
  return options.undistort ? camera : camera.rectified();
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
  Impl(const FrontendOptions& options, const CameraIntrinsics& camera, KeyframeId first_id,
       int first_segment = 0)
      : options_(checked(options)),
        camera_(trackedCamera(camera, options)),
        session_(options_, camera_, first_id, first_segment) {
    if (first_id.robot.empty()) {
      throw std::invalid_argument("a frontend needs the name of its robot");
    }
  }

  FrameResult track(const RgbdFrame& raw,
                    const std::optional<Eigen::Isometry3d>& T_previous_current) {
    checkSize(raw.grey.width(), raw.grey.height(), camera_, "colour");
    checkSize(raw.depth.width(), raw.depth.height(), camera_, "depth");
    if (!raw.color.empty()) checkSize(raw.color.width(), raw.color.height(), camera_, "texture's");
    if (raw.stamp < last_stamp_) startAfresh();
    last_stamp_ = raw.stamp;
    return session_.track(raw, T_previous_current);
  }

  std::unique_ptr<Impl> continueWith(const CameraIntrinsics& camera) {
    auto next = std::make_unique<Impl>(options_, camera, session_.nextId(), session_.nextSegment());
    session_.endSegment();
    for (CompletedKeyframe& completed : session_.takeCompleted()) {
      next->completed_.push_back(std::move(completed));
    }
    next->session_.setNextPose(session_.nextPose());
    return next;
  }

  std::vector<CompletedKeyframe> takeCompleted() {
    std::vector<CompletedKeyframe> completed = std::exchange(completed_, {});
    for (CompletedKeyframe& keyframe : session_.takeCompleted()) {
      completed.push_back(std::move(keyframe));
    }
    return completed;
  }

  void startAfresh() {
    session_.endSegment();
    session_.forgetHistory();
  }

  void setKeyframeOptions(const KeyframeSelectorOptions& options) {
    session_.setKeyframeOptions(options);
    options_.keyframe = options;
  }

  TrackingSession& session() { return session_; }

 private:
  FrontendOptions options_;
  const CameraIntrinsics camera_;
  TrackingSession session_;
  std::vector<CompletedKeyframe> completed_;  ///< in an earlier camera
  double last_stamp_ = 0.0;
};

Frontend::Frontend(const FrontendOptions& options, const CameraIntrinsics& camera,
                   std::string robot, std::uint64_t session)
    : impl_(std::make_unique<Impl>(options, camera, KeyframeId{std::move(robot), session, 0})) {}
Frontend::~Frontend() = default;
Frontend::Frontend(Frontend&&) noexcept = default;
Frontend& Frontend::operator=(Frontend&&) noexcept = default;

FrameResult Frontend::track(const RgbdFrame& frame,
                            const std::optional<Eigen::Isometry3d>& T_previous_current) {
  return impl_->track(frame, T_previous_current);
}

std::vector<CompletedKeyframe> Frontend::takeCompleted() { return impl_->takeCompleted(); }

void Frontend::finish() { impl_->session().endSegment(); }

void Frontend::startNewSegment() { impl_->startAfresh(); }

void Frontend::changeCamera(const CameraIntrinsics& camera) { impl_ = impl_->continueWith(camera); }

void Frontend::setKeyframeOptions(const KeyframeSelectorOptions& options) {
  impl_->setKeyframeOptions(options);
}

void Frontend::setNextPose(const Eigen::Isometry3d& T_odom_camera) {
  impl_->session().setNextPose(T_odom_camera);
}

}  // namespace planecloud

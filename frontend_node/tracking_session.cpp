// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/frontend_node/tracking_session.h"

#include <algorithm>
#include <utility>
namespace planecloud {
namespace {

/// Frames farther apart than this do not count as time on usable images [s].
constexpr double kLongestFrameGap = 0.2;

/// Who made the track be lost may still be in the view for so long after it was regained [s].
constexpr double kWaryTime = 1.0;

/// Keyframes that tell what has moved into a new one: who walks by is gone from a place within as
/// many.
constexpr std::size_t kEarlierImages = 4;

/// A level camera looking along x of the odometry frame (x forward, y left, z up).
Eigen::Isometry3d levelledCamera() {
  Eigen::Isometry3d T_odom_camera = Eigen::Isometry3d::Identity();
  T_odom_camera.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return T_odom_camera;
}

}  // namespace

TrackingSession::TrackingSession(const FrontendOptions& options, const CameraIntrinsics& camera,
                                 KeyframeId first_id, int first_segment)
    : options_(options),
      images_(camera, options.tracking),
      tracker_(options.tracking),
      selector_(options.keyframe),
      loss_(options.lost),
      relocaliser_(options.history, options.tracking),
      open_(options.local_map, camera.rectified()),
      next_id_(std::move(first_id)),
      next_segment_(first_segment),
      T_odom_start_(levelledCamera()) {
  if (options.tracking.plane_landmarks) landmarks_.emplace(camera.rectified(), options.plane_fit);
}

FrameResult TrackingSession::track(const RgbdFrame& frame,
                                   const std::optional<Eigen::Isometry3d>& T_previous_current) {
  predictMotion(frame.stamp, T_previous_current);
  FrameResult result = process(frame);
  result.stamp = frame.stamp;
  result.segment = segment_;
  last_stamp_ = frame.stamp;
  return result;
}

std::vector<CompletedKeyframe> TrackingSession::takeCompleted() {
  return std::exchange(completed_, {});
}

/// Where the frame at `stamp` should be, from wheel odometry, else at constant velocity.
void TrackingSession::predictMotion(double stamp,
                                    const std::optional<Eigen::Isometry3d>& T_previous_current) {
  if (!isTracking()) return;
  wheels_since_good_ = T_previous_current && (wheels_since_good_ || !isLost());
  if (T_previous_current) {
    wheels_.add(*T_previous_current);
    T_reference_predicted_ = T_reference_predicted_ * *T_previous_current;
  } else if (const auto T_last_current = motion_.after(stamp - last_stamp_);
             T_last_current && !isLost()) {
    T_reference_predicted_ = T_reference_last_ * *T_last_current;
  }
  if (planar_) T_reference_predicted_ = planar_->nearest(T_reference_predicted_);
}

/// Motion of the camera between colour and depth image, T_color_depth.
Eigen::Isometry3d TrackingSession::motionToDepth(const RgbdFrame& frame) const {
  const std::optional<Eigen::Isometry3d> T_color_depth = motion_.after(-frame.color_delay);
  const bool is_known = options_.tracking.color_motion && T_color_depth && !isLost();
  return is_known ? *T_color_depth : Eigen::Isometry3d::Identity();
}

FrameResult TrackingSession::process(const RgbdFrame& frame) {
  const std::string image_fault = loss_.findImageFault(frame);
  if (!image_fault.empty()) {
    last_was_usable_ = false;
    return lose(image_fault);
  }
  images_.assign(frame, motionToDepth(frame));
  if (!isTracking()) return openSegment(frame);
  if (frame.stamp - last_good_stamp_ > options_.lost.max_gap) {
    return recover(frame, "the keyframe is not recognised after a gap");
  }
  const Alignment alignment =
      tracker_.align(*reference_.points, images_.pyramid(),
                     {{T_reference_predicted_, T_reference_last_}, brightness_});
  const bool leaving = selector_.isLeavingKeyframe(alignment.T_reference_current,
                                                   alignment.normal_matrix, alignment.overlap);
  const std::string fault = loss_.findAlignmentFault(alignment, motionOf(alignment, frame.stamp));
  return fault.empty() ? accept(frame, alignment, leaving) : recover(frame, fault);
}

TrackedMotion TrackingSession::motionOf(const Alignment& alignment, double stamp) const {
  TrackedMotion motion;
  motion.entropy_ratio = selector_.entropyRatio();
  motion.T_previous_current = T_reference_last_.inverse() * alignment.T_reference_current;
  motion.seconds = stamp - last_good_stamp_;
  if (wheels_since_good_) {
    motion.T_previous_current_wheels = T_reference_last_.inverse() * T_reference_predicted_;
  }
  return motion;
}

FrameResult TrackingSession::accept(const RgbdFrame& frame, const Alignment& alignment,
                                    bool leaving) {
  const Eigen::Isometry3d& T_reference_camera = alignment.T_reference_current;
  const double seconds = frame.stamp - last_good_stamp_;
  if (seconds > 0.0) motion_.observe(T_reference_last_.inverse() * T_reference_camera, seconds);
  T_reference_last_ = T_reference_predicted_ = T_reference_camera;
  wheels_ = WheelPath{};
  brightness_ = alignment.brightness;
  const bool is_obstructed = loss_.isObstructed(alignment, frame.stamp < wary_until_);
  if (!is_obstructed) loss_.learn(alignment);
  if (loss_.isOrdinary(alignment)) {
    last_good_.set(alignment);
    images_.keep();
  }
  last_good_stamp_ = frame.stamp;
  usable_lost_ = 0.0;
  last_was_usable_ = true;

  FrameResult result;
  result.status = TrackingStatus::kTracked;
  result.T_odom_camera = reference_.view->T_odom_camera * T_reference_camera;
  result.reference = reference_.view->id;
  result.T_reference_camera = T_reference_camera;
  result.information = alignment.information;
  result.overlap = alignment.overlap;
  result.inliers = alignment.inliers;
  result.grey_residual = alignment.scale.sigma_grey;
  if (leaving && !is_obstructed) {
    openKeyframe(frame, result.T_odom_camera,
                 {{result.reference, T_reference_camera, result.information}});
  } else {
    open_.fuse(images_.depth(frame), T_reference_camera);
  }
  return result;
}

/// The reference could not be followed on an image that is good enough for it: looks for it and
/// for earlier keyframes without trust in the motion.
FrameResult TrackingSession::recover(const RgbdFrame& frame, const std::string& fault) {
  const double since_last = frame.stamp - last_stamp_;
  if (last_was_usable_ && isLost()) usable_lost_ += std::min(since_last, kLongestFrameGap);
  last_was_usable_ = true;
  const auto is_doubtless = [this](const Alignment& alignment, bool is_lenient) {
    return loss_.findDoubt(alignment, is_lenient).empty();
  };
  const std::optional<Relocalisation> found =
      relocaliser_.find(images_.pyramid(), expectedPlaces(frame.stamp), history_, is_doubtless);
  if (found) return resume(frame, *found);
  if (usable_lost_ < options_.lost.new_segment_after) return lose(fault);
  if (wheels_since_good_) return bridgeByWheels(frame);
  endSegment();
  return openSegment(frame);
}

/// The keyframe and the last good image, and where the camera may have gone there since: what is
/// predicted first.
std::vector<ExpectedPlace> TrackingSession::expectedPlaces(double stamp) {
  std::vector<Eigen::Isometry3d> poses = {T_reference_predicted_, T_reference_last_};
  for (const Eigen::Isometry3d& T : motion_.possibleMotions(stamp - last_good_stamp_)) {
    poses.push_back(T_reference_last_ * T);
  }
  std::vector<ExpectedPlace> places = {{reference_.view, reference_.points, poses}};
  if (last_good_.isSet()) {
    places.push_back(last_good_.place(*reference_.view, images_.kept(), options_.tracking, poses));
  }
  return places;
}

FrameResult TrackingSession::resume(const RgbdFrame& frame, const Relocalisation& found) {
  wary_until_ = frame.stamp + kWaryTime;
  // Out of the keyframe's sight: a new one begins here.
  if (last_good_.isAt(found)) return accept(frame, last_good_.toKeyframe(found.alignment), true);
  const bool is_elsewhere = found.view != reference_.view;
  if (is_elsewhere) {
    switchTo(found);
    last_good_stamp_ = frame.stamp;  // the last good pose was relative to another keyframe
  }
  const bool leaving = selector_.isLeavingKeyframe(
      found.alignment.T_reference_current, found.alignment.normal_matrix, found.alignment.overlap);
  FrameResult result = accept(frame, found.alignment, leaving);
  if (is_elsewhere) {
    result.status = TrackingStatus::kRelocalised;
    motion_.forget();
  }
  return result;
}

/// The pose stays where it was last known, or goes with the wheels.
FrameResult TrackingSession::lose(const std::string& reason) {
  motion_.forget();
  FrameResult result;
  result.status = TrackingStatus::kLost;
  result.reason = reason;
  result.T_odom_camera = T_odom_start_;
  if (!isTracking()) return result;
  result.reference = reference_.view->id;
  result.T_reference_camera = wheels_since_good_ ? T_reference_predicted_ : T_reference_last_;
  result.T_odom_camera = reference_.view->T_odom_camera * result.T_reference_camera;
  return result;
}

/// Nothing is recognised, but the wheels know the way: the segment goes on with a weak edge.
FrameResult TrackingSession::bridgeByWheels(const RgbdFrame& frame) {
  const RelativePoseEdge edge{reference_.view->id, T_reference_predicted_, wheels_.information()};
  FrameResult result;
  result.status = TrackingStatus::kRelocalised;
  result.T_odom_camera = reference_.view->T_odom_camera * T_reference_predicted_;
  result.reference = edge.other;
  result.T_reference_camera = edge.T_other_this;
  result.information = edge.information;
  openKeyframe(frame, result.T_odom_camera, {edge});
  last_good_stamp_ = frame.stamp;
  return result;
}

FrameResult TrackingSession::openSegment(const RgbdFrame& frame) {
  segment_ = next_segment_++;
  if (options_.planar) restrictToFloor();
  openKeyframe(frame, T_odom_start_, {});
  last_good_stamp_ = frame.stamp;
  FrameResult result;
  result.status = TrackingStatus::kInitialised;
  result.T_odom_camera = T_odom_start_;
  result.reference = reference_.view->id;
  return result;
}

/// Up is where the z axis of the odometry frame points.
void TrackingSession::restrictToFloor() {
  planar_.emplace(T_odom_start_.linear().transpose() * Eigen::Vector3d::UnitZ());
  tracker_.setPlanarMotion(planar_);
  relocaliser_.setPlanarMotion(planar_);
}

void TrackingSession::openKeyframe(const RgbdFrame& frame, const Eigen::Isometry3d& T_odom_camera,
                                   std::vector<RelativePoseEdge> edges) {
  completeKeyframe();
  reference_.view = std::make_shared<const KeyframeView>(KeyframeView{
      next_id_, segment_, T_odom_camera, images_.pyramid(), describeView(images_.pyramid())});
  if (landmarks_) landmarks_->assign(images_.depth(frame));
  reference_.points = std::make_shared<const TrackingReference>(
      images_.pyramid(), options_.tracking, earlierImages(T_odom_camera),
      landmarks_ ? &*landmarks_ : nullptr);
  ++next_id_.number;
  open_.open(images_.full(frame), reference_, std::move(edges));
  brightness_ = Brightness{};
  T_reference_last_ = T_reference_predicted_ = Eigen::Isometry3d::Identity();
  wheels_ = WheelPath{};
  last_good_.forget();
  usable_lost_ = 0.0;
  selector_.reset();
}

/// The last keyframes of this segment, as seen from a camera at `T_odom_camera`.
std::vector<EarlierImage> TrackingSession::earlierImages(
    const Eigen::Isometry3d& T_odom_camera) const {
  std::vector<EarlierImage> images;
  for (auto view = history_.rbegin(); view != history_.rend(); ++view) {
    if (images.size() == kEarlierImages || (*view)->segment != segment_) break;
    images.push_back({&(*view)->pyramid, (*view)->T_odom_camera.inverse() * T_odom_camera});
  }
  return images;
}

void TrackingSession::switchTo(const Relocalisation& found) {
  completeKeyframe();
  reference_ = {found.view, found.reference};
  segment_ = found.view->segment;
  last_good_.forget();
  selector_.reset();
}

void TrackingSession::completeKeyframe() {
  if (!open_.isOpen()) return;
  completed_.push_back(open_.complete({history_.begin(), history_.end()}));
  history_.push_back(completed_.back().history.view);
  if (history_.size() > static_cast<std::size_t>(options_.history.keyframes)) history_.pop_front();
}

void TrackingSession::endSegment() {
  if (!isTracking()) return;
  completeKeyframe();
  T_odom_start_ = reference_.view->T_odom_camera * T_reference_last_;
  reference_ = {};
  motion_.forget();
}

}  // namespace planecloud

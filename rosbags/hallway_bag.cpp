// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/rosbags/hallway_bag.h"

#include <nav_msgs/Odometry.h>

#include <memory>
#include <utility>
#include <vector>

#include "planecloud_slam/planecloud_msgs/pose_conversions.h"
#include "planecloud_slam/rosbags/bag_writer.h"

namespace planecloud {
namespace {

using Transforms = std::vector<geometry_msgs::TransformStamped>;

ros::Time stampOf(std::size_t index, int rate) {
  ros::Time stamp;
  return stamp.fromNSec(HallwayRecording::stampNanoseconds(index, rate));
}

/// base_footprint -> base_link -> camera_link -> optical frame, whose product is T_base_camera.
Transforms mountOf(const std::string& space) {
  const Eigen::Isometry3d T_base_camera = HallwayRecording::T_base_camera();
  Eigen::Isometry3d T_base_link = Eigen::Isometry3d::Identity();
  T_base_link.translation().z() = 0.0102;
  Eigen::Isometry3d T_link_optical = Eigen::Isometry3d::Identity();
  T_link_optical.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  const Eigen::Isometry3d T_link_camera =
      T_base_link.inverse() * T_base_camera * T_link_optical.inverse();
  const ros::Time stamp = stampOf(0, 1);
  const auto name = [&](const std::string& frame) { return frameIn(space, frame); };
  return {transformMessage(T_base_link, stamp, name("base_footprint"), name("base_link")),
          transformMessage(T_link_camera, stamp, name("base_link"), name("camera_link")),
          transformMessage(T_link_optical, stamp, name("camera_link"),
                           name("camera_rgb_optical_frame"))};
}

/// One robot on its way into the bag.
class RobotStream {
 public:
  RobotStream(std::unique_ptr<HallwayRecording> recording, std::string space, bool color)
      : recording_(std::move(recording)),
        space_(std::move(space)),
        color_(color),
        topics_(rectifiedTopics(space_)) {}

  /// The wheels' messages up to the next frame, then the frame; false at the end.
  bool writeNext(BagWriter& bag) {
    const ros::Time stamp = stampOf(frame_, HallwayRecording::kFramesPerSecond);
    const std::optional<RgbdFrame> frame = recording_->next();
    if (!frame) return false;
    while (sample_ < recording_->odometry().size()) {
      const ros::Time sample_stamp = stampOf(sample_, HallwayRecording::kOdometryPerSecond);
      if (sample_stamp > stamp) break;
      writeOdometry(bag, recording_->odometry()[sample_++], sample_stamp);
    }
    bag.writeGroundTruth(space_ + "/ground_truth", recording_->groundTruth()[frame_]);
    bag.writeCameraInfo(topics_, recording_->camera(), stamp);
    if (color_) {
      bag.writeColor(topics_, recording_->color(), stamp);
    } else {
      bag.writeGrey(topics_, frame->grey, stamp);
    }
    bag.writeDepth(topics_, recording_->depthMillimetres(), stamp);
    ++frame_;
    return true;
  }

 private:
  void writeOdometry(BagWriter& bag, const BaseState& state, const ros::Time& stamp) const {
    const Eigen::Isometry3d T_odom_base = toTransform(state);
    bag.writeTransform(transformMessage(T_odom_base, stamp, frameIn(space_, "odom"),
                                        frameIn(space_, "base_footprint")));
    nav_msgs::Odometry odometry;
    odometry.header.stamp = stamp;
    odometry.header.frame_id = frameIn(space_, "odom");
    odometry.child_frame_id = frameIn(space_, "base_footprint");
    odometry.pose.pose = toPoseMessage(T_odom_base);
    odometry.twist.twist.linear.x = state.speed;
    odometry.twist.twist.angular.z = state.turn_rate;
    bag.write(space_ + "/odom", odometry);
  }

  std::unique_ptr<HallwayRecording> recording_;
  std::string space_;
  bool color_;
  CameraTopics topics_;
  std::size_t frame_ = 0;
  std::size_t sample_ = 0;
};

}  // namespace

void writeHallwayBag(const HallwayBagOptions& options, const std::string& path,
                     const std::function<void()>& progress) {
  std::vector<RobotStream> robots;
  Transforms mounts;
  for (std::unique_ptr<HallwayRecording>& recording : makeHallwayRecordings(options.world)) {
    const std::string space = options.world.robots > 1 ? "/" + recording->robot() : "";
    for (const auto& transform : mountOf(space)) mounts.push_back(transform);
    robots.emplace_back(std::move(recording), space, options.color);
  }
  BagWriter bag(path);
  bag.writeStaticTransforms(mounts);
  bool more = true;
  while (more) {
    for (RobotStream& robot : robots) {
      more = robot.writeNext(bag);
      if (more && progress) progress();
    }
  }
  bag.close();
}

}  // namespace planecloud

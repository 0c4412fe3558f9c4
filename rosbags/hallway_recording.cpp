// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/rosbags/hallway_recording.h"

#include <algorithm>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "planecloud_slam/plane_fit/option_fields.h"
#include "planecloud_slam/rosbags/seeded_random.h"
#include "planecloud_slam/rosbags/sequence_folder.h"

namespace planecloud {
namespace {

constexpr std::uint64_t kStartSeconds = 1600000000;  // of every recording, since the epoch

const HallwayOptions& checked(const HallwayOptions& options) {
  checkRange("robots", options.robots, 1, 16);
  checkRange("robot", options.robot, 0, options.robots - 1);
  return options;
}

DriveKind driveOf(const HallwayOptions& options) {
  constexpr DriveKind kInTurn[] = {DriveKind::kLoop, DriveKind::kFromLab, DriveKind::kFarLoop};
  return options.drive.value_or(kInTurn[options.robot % 3]);
}

/// Seconds as ros::Time::toSec() computes them, so that stamps survive a bag unchanged.
double toSeconds(std::uint64_t nanoseconds) {
  return static_cast<double>(nanoseconds / 1000000000) +
         1e-9 * static_cast<double>(nanoseconds % 1000000000);
}

Image<float> toMetres(const Image<std::uint16_t>& millimetres) {
  Image<float> metres(millimetres.width(), millimetres.height());
  std::transform(millimetres.begin(), millimetres.end(), metres.begin(), [](std::uint16_t depth) {
    return depth == 0 ? std::numeric_limits<float>::quiet_NaN()
                      : 0.001F * static_cast<float>(depth);
  });
  return metres;
}

cv::Mat toBgr(Image<Rgb8> color) {
  const cv::Mat rgb(color.height(), color.width(), CV_8UC3, color.begin());
  cv::Mat bgr;
  cv::cvtColor(rgb, bgr, cv::COLOR_RGB2BGR);
  return bgr;
}

}  // namespace

CameraIntrinsics astraCamera() {
  CameraIntrinsics camera;
  camera.width = 640;
  camera.height = 480;
  camera.fx = camera.fy = 570.0;
  camera.cx = 319.5;
  camera.cy = 239.5;
  return camera;
}

HallwayRecording::HallwayRecording(const HallwayOptions& options,
                                   std::shared_ptr<const HallwayWorld> world)
    : options_(checked(options)),
      robot_("robot" + std::to_string(options.robot + 1)),
      noise_seed_(hashOf(options.seed, 0xa57a, static_cast<std::uint64_t>(options.robot))),
      renderer_(world ? std::move(world) : std::make_shared<HallwayWorld>(options.seed),
                options.camera) {
  const RobotPath path(driveOf(options), noise_seed_, options.duration);
  const std::vector<BaseState> wheels = wheelOdometry(path, noise_seed_);
  constexpr std::size_t kFrameSteps = RobotPath::kStepsPerSecond / kFramesPerSecond;
  constexpr std::size_t kOdometrySteps = RobotPath::kStepsPerSecond / kOdometryPerSecond;
  for (std::size_t i = 0; i * kFrameSteps < path.states().size(); ++i) {
    ground_truth_.push_back({toSeconds(stampNanoseconds(i, kFramesPerSecond)),
                             toTransform(path.states()[i * kFrameSteps]) * T_base_camera()});
  }
  for (std::size_t i = 0; i < wheels.size(); i += kOdometrySteps) odometry_.push_back(wheels[i]);
}

std::uint64_t HallwayRecording::stampNanoseconds(std::size_t index, int rate) {
  return kStartSeconds * 1000000000 + index * 1000000000 / static_cast<std::uint64_t>(rate);
}

Eigen::Isometry3d HallwayRecording::T_base_camera() {
  constexpr double kPitchDown = 2.0 * M_PI / 180.0;
  Eigen::Matrix3d axes;  // of the optical frame: right, down, forward
  axes << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  transform.translation() << -0.03, -0.0125, 0.52;
  transform.linear() =
      Eigen::AngleAxisd(kPitchDown, Eigen::Vector3d::UnitY()).toRotationMatrix() * axes;
  return transform;
}

std::optional<RgbdFrame> HallwayRecording::next() {
  if (position_ == ground_truth_.size()) return std::nullopt;
  const StampedPose& truth = ground_truth_[position_];
  RenderedView view = renderer_.render(truth.pose);
  const AstraSensorModel sensor;
  const SensorFrame sensed{noise_seed_, position_,
                           static_cast<double>(position_) / kFramesPerSecond};
  ++position_;
  depth_ = options_.noise ? sensor.senseDepth(view, sensed) : toMillimetres(view.depth);
  color_ = toBgr(options_.noise ? sensor.senseColor(view, sensed) : toRgb8(view.color));
  true_depth_ = std::move(view.depth);
  return RgbdFrame{truth.stamp, greyFromColor(color_), toMetres(depth_), {}};
}

std::vector<std::unique_ptr<HallwayRecording>> makeHallwayRecordings(
    const HallwayOptions& options) {
  const auto world = std::make_shared<HallwayWorld>(options.seed);
  std::vector<std::unique_ptr<HallwayRecording>> recordings;
  for (int robot = 0; robot < options.robots; ++robot) {
    HallwayOptions own = options;
    own.robot = robot;
    recordings.push_back(std::make_unique<HallwayRecording>(own, world));
  }
  return recordings;
}

}  // namespace planecloud

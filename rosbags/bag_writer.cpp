// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/rosbags/bag_writer.h"

#include <geometry_msgs/PoseStamped.h>
#include <nav_msgs/Odometry.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>
#include <boost/make_shared.hpp>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <system_error>

#include "planecloud_slam/planecloud_msgs/pose_conversions.h"

namespace planecloud {
namespace {

sensor_msgs::Image imageMessage(const cv::Mat& pixels, const std::string& encoding) {
  sensor_msgs::Image message;
  message.height = static_cast<std::uint32_t>(pixels.rows);
  message.width = static_cast<std::uint32_t>(pixels.cols);
  message.encoding = encoding;
  message.is_bigendian = __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__;
  message.step =
      static_cast<std::uint32_t>(static_cast<std::size_t>(pixels.cols) * pixels.elemSize());
  message.data.resize(std::size_t{message.step} * message.height);
  for (int y = 0; y < pixels.rows; ++y) {
    std::memcpy(message.data.data() + static_cast<std::size_t>(y) * message.step, pixels.ptr(y),
                message.step);
  }
  return message;
}

template <typename Pixel>
cv::Mat asMat(const Image<Pixel>& image, int type) {
  // cv::Mat has no const view; it is only read.
  return {image.height(), image.width(), type, const_cast<Pixel*>(image.begin())};
}

/// What rosbag records of a latched publisher, so that a player latches too.
template <typename Message>
boost::shared_ptr<ros::M_string> latchedConnection(const std::string& topic) {
  auto header = boost::make_shared<ros::M_string>();
  (*header)["topic"] = topic;
  (*header)["type"] = ros::message_traits::datatype<Message>();
  (*header)["md5sum"] = ros::message_traits::md5sum<Message>();
  (*header)["message_definition"] = ros::message_traits::definition<Message>();
  (*header)["latching"] = "1";
  return header;
}

std::runtime_error diskError(const std::string& path, const std::string& cause) {
  return std::runtime_error("cannot write '" + path + "': " + cause +
                            "; check that the folder exists and the disk has room");
}

}  // namespace

CameraTopics rectifiedTopics(const std::string& space) {
  const std::string camera = space + "/camera";
  return {camera + "/rgb/image_rect_color", camera + "/depth_registered/image_raw",
          camera + "/rgb/camera_info", frameIn(space, "camera_rgb_optical_frame")};
}

CameraTopics rawTopics() {
  return {"/camera/rgb/image_color", "/camera/depth/image", "/camera/rgb/camera_info",
          "camera_rgb_optical_frame"};
}

std::string frameIn(const std::string& space, const std::string& frame) {
  return space.empty() ? frame : space.substr(1) + "/" + frame;
}

geometry_msgs::TransformStamped transformMessage(const Eigen::Isometry3d& T_parent_child,
                                                 const ros::Time& stamp, const std::string& parent,
                                                 const std::string& child) {
  geometry_msgs::TransformStamped message;
  message.header.stamp = stamp;
  message.header.frame_id = parent;
  message.child_frame_id = child;
  message.transform = toTransformMessage(T_parent_child);
  return message;
}

ros::Time toRosTime(double stamp) {
  const double seconds = std::floor(stamp);
  const auto nanoseconds = static_cast<std::uint32_t>(std::llround((stamp - seconds) * 1e9));
  ros::Time time(static_cast<std::uint32_t>(seconds), 0);
  return time + ros::Duration(0, static_cast<std::int32_t>(nanoseconds));
}

BagWriter::BagWriter(const std::string& path) : path_(path) {
  try {
    bag_.open(path, rosbag::bagmode::Write);
  } catch (const rosbag::BagException& error) {
    throw diskError(path, error.what());
  }
  // bz2 would make the images half as large, but keep a small computer from playing in time.
  bag_.setCompression(rosbag::compression::LZ4);
}

BagWriter::~BagWriter() {
  if (is_closed_) return;
  try {
    bag_.close();
  } catch (const rosbag::BagException&) {  // it goes anyway
  }
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
}

void BagWriter::close() {
  try {
    bag_.close();
    is_closed_ = true;
  } catch (const rosbag::BagException& error) {
    throw diskError(path_, error.what());
  }
}

template <typename Message>
void BagWriter::writeAt(const std::string& topic, const ros::Time& stamp, const Message& message) {
  try {
    bag_.write(topic, stamp, message);
  } catch (const rosbag::BagException& error) {
    throw diskError(path_, error.what());
  }
}

template void BagWriter::writeAt(const std::string&, const ros::Time&, const nav_msgs::Odometry&);
template void BagWriter::writeAt(const std::string&, const ros::Time&, const sensor_msgs::Image&);

void BagWriter::writeCameraInfo(const CameraTopics& topics, const CameraIntrinsics& camera,
                                const ros::Time& stamp) {
  sensor_msgs::CameraInfo info;
  info.header.stamp = stamp;
  info.header.frame_id = topics.frame;
  info.width = static_cast<std::uint32_t>(camera.width);
  info.height = static_cast<std::uint32_t>(camera.height);
  info.distortion_model = "plumb_bob";
  info.D.assign(camera.distortion.begin(), camera.distortion.end());
  info.K = {camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1};
  info.R = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  info.P = {camera.fx, 0, camera.cx, 0, 0, camera.fy, camera.cy, 0, 0, 0, 1, 0};
  write(topics.camera_info, info);
}

void BagWriter::writeImage(const std::string& topic, const CameraTopics& topics,
                           const cv::Mat& pixels, const std::string& encoding,
                           const ros::Time& stamp) {
  sensor_msgs::Image message = imageMessage(pixels, encoding);
  message.header.stamp = stamp;
  message.header.frame_id = topics.frame;
  write(topic, message);
}

void BagWriter::writeColor(const CameraTopics& topics, const cv::Mat& bgr, const ros::Time& stamp) {
  cv::Mat rgb;
  cv::cvtColor(bgr, rgb, cv::COLOR_BGR2RGB);
  writeImage(topics.color, topics, rgb, "rgb8", stamp);
}

void BagWriter::writeGrey(const CameraTopics& topics, const Image<std::uint8_t>& grey,
                          const ros::Time& stamp) {
  writeImage(topics.color, topics, asMat(grey, CV_8UC1), "mono8", stamp);
}

void BagWriter::writeDepth(const CameraTopics& topics, const Image<std::uint16_t>& depth,
                           const ros::Time& stamp) {
  writeImage(topics.depth, topics, asMat(depth, CV_16UC1), "16UC1", stamp);
}

void BagWriter::writeDepth(const CameraTopics& topics, const Image<float>& depth,
                           const ros::Time& stamp) {
  writeImage(topics.depth, topics, asMat(depth, CV_32FC1), "32FC1", stamp);
}

void BagWriter::writeGroundTruth(const std::string& topic, const StampedPose& truth) {
  geometry_msgs::PoseStamped message;
  message.header.stamp = toRosTime(truth.stamp);
  message.header.frame_id = "world";
  message.pose = toPoseMessage(truth.pose);
  write(topic, message);
}

void BagWriter::writeTransform(const geometry_msgs::TransformStamped& transform) {
  tf2_msgs::TFMessage message;
  message.transforms.push_back(transform);
  writeAt("/tf", transform.header.stamp, message);
}

void BagWriter::writeStaticTransforms(
    const std::vector<geometry_msgs::TransformStamped>& transforms) {
  tf2_msgs::TFMessage message;
  message.transforms = transforms;
  const std::string topic = "/tf_static";
  try {
    bag_.write(topic, transforms.front().header.stamp, message,
               latchedConnection<tf2_msgs::TFMessage>(topic));
  } catch (const rosbag::BagException& error) {
    throw diskError(path_, error.what());
  }
}

}  // namespace planecloud

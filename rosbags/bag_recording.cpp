// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/rosbags/bag_recording.h"

#include <geometry_msgs/PoseStamped.h>
#include <sensor_msgs/CameraInfo.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <utility>

#include "planecloud_slam/planecloud_msgs/image_conversions.h"
#include "planecloud_slam/planecloud_msgs/pose_conversions.h"

namespace planecloud {
namespace {

constexpr double kPairTolerance = 0.02 + 1e-6;  // between the stamps of a pair, rounded [s]
constexpr double kBackwards = 1.0;              // a larger step back is time running backwards [s]

double stampOf(const sensor_msgs::ImageConstPtr& image) { return image->header.stamp.toSec(); }

std::string sizeText(std::size_t width, std::size_t height) {
  return std::to_string(width) + " x " + std::to_string(height);
}

void openFile(const std::string& path, rosbag::Bag& bag) {
  try {
    bag.open(path, rosbag::bagmode::Read);
  } catch (const rosbag::BagException& error) {
    throw std::runtime_error("cannot read '" + path + "': " + error.what());
  }
}

/// A bag that was not closed says so; one that was cut later points to an index that is gone.
BagSource openSource(const std::string& path, const std::function<void(const std::string&)>& warn) {
  BagSource source{path, nullptr};
  rosbag::Bag bag;
  try {
    openFile(path, bag);
  } catch (const std::runtime_error&) {
    if (!RecoveredBag::isBag(path)) throw;
    source.recovered = std::make_shared<RecoveredBag>(path);
    if (warn) {
      warn("'" + path + "' ends in mid-recording and has no index: " +
           std::to_string(source.recovered->messages()) +
           " messages could be read and are used; `rosbag reindex` repairs the file");
    }
  }
  return source;
}

std::vector<BagTopic> topicsOf(const rosbag::Bag& bag) {
  std::vector<BagTopic> topics;
  for (const rosbag::ConnectionInfo* connection : rosbag::View(bag).getConnections()) {
    const auto same = [&](const BagTopic& topic) { return topic.name == connection->topic; };
    if (std::none_of(topics.begin(), topics.end(), same)) {
      topics.push_back({connection->topic, connection->datatype});
    }
  }
  return topics;
}

}  // namespace

BagRecording::BagRecording(BagSource source, RobotTopics topics)
    : source_(std::move(source)), topics_(std::move(topics)) {
  openFile(source_.file(), bag_);
  readCamera();
  readGroundTruth();
  size_ = rosbag::View(bag_, rosbag::TopicQuery(topics_.depth)).size();
  const std::vector<std::string> images{topics_.color, topics_.depth};
  view_ = std::make_unique<rosbag::View>(bag_, rosbag::TopicQuery(images));
  position_ = view_->begin();
}

void BagRecording::refuse(const std::string& topic, const std::string& cause) const {
  throw std::runtime_error("'" + source_.path + "', " + topic + ": " + cause);
}

void BagRecording::readCamera() {
  rosbag::View infos(bag_, rosbag::TopicQuery(topics_.camera_info));
  for (const rosbag::MessageInstance& instance : infos) {
    const auto info = instance.instantiate<sensor_msgs::CameraInfo>();
    if (!info) continue;
    try {
      camera_ = fromMessage(*info, topics_.color.find("rect") != std::string::npos);
    } catch (const MessageError& error) {
      refuse(topics_.camera_info, error.what());
    }
    return;
  }
  refuse(topics_.camera_info, "no message: record it together with the images");
}

void BagRecording::readGroundTruth() {
  if (topics_.ground_truth.empty()) return;
  rosbag::View poses(bag_, rosbag::TopicQuery(topics_.ground_truth));
  for (const rosbag::MessageInstance& instance : poses) {
    const auto pose = instance.instantiate<geometry_msgs::PoseStamped>();
    if (!pose) continue;
    ground_truth_.push_back({pose->header.stamp.toSec(), fromMessage(pose->pose)});
  }
  std::stable_sort(ground_truth_.begin(), ground_truth_.end(),
                   [](const StampedPose& a, const StampedPose& b) { return a.stamp < b.stamp; });
}

std::optional<RgbdFrame> BagRecording::next() {
  bool at_end = false;
  while (true) {
    if (const std::optional<ImagePair> pair = takePair(at_end)) return decode(*pair);
    if (at_end) return std::nullopt;
    at_end = !readMessage();
  }
}

bool BagRecording::readMessage() {
  try {
    if (position_ == view_->end()) return false;
    const rosbag::MessageInstance& instance = *position_;
    const bool is_depth = instance.getTopic() == topics_.depth;
    if (const auto image = instance.instantiate<sensor_msgs::Image>()) receive(image, is_depth);
    ++position_;
    return true;
  } catch (const ros::Exception& error) {  // rosbag's and the deserialiser's
    refuse(topics_.depth, "damaged after " + std::to_string(returned_) + " frames (" +
                              error.what() +
                              "); `rosbag reindex` or `rosbag filter` may save more");
  }
}

void BagRecording::receive(const sensor_msgs::ImageConstPtr& image, bool is_depth) {
  const double stamp = stampOf(image);
  if (stamp < newest_ - kBackwards) {
    colors_.clear();
    depths_.clear();
    newest_ = stamp;
  }
  newest_ = std::max(newest_, stamp);
  (is_depth ? depths_ : colors_).push_back(image);
}

std::optional<BagRecording::ImagePair> BagRecording::takePair(bool at_end) {
  while (!depths_.empty()) {
    const double stamp = stampOf(depths_.front());
    // A nearer colour image may still come.
    if (!at_end && (colors_.empty() || stampOf(colors_.back()) < stamp)) return std::nullopt;
    const sensor_msgs::ImageConstPtr depth = depths_.front();
    depths_.pop_front();
    const auto distance = [&](const auto& color) { return std::abs(stampOf(color) - stamp); };
    const auto nearest =
        std::min_element(colors_.begin(), colors_.end(),
                         [&](const auto& a, const auto& b) { return distance(a) < distance(b); });
    if (nearest == colors_.end() || distance(*nearest) > kPairTolerance) continue;
    const ImagePair pair{*nearest, depth};
    colors_.erase(colors_.begin(), nearest + 1);
    return pair;
  }
  // Without depth images colour would pile up.
  while (colors_.size() > 100) colors_.pop_front();
  return std::nullopt;
}

void BagRecording::checkSizes(const ImagePair& pair) const {
  const std::string color = sizeText(pair.color->width, pair.color->height);
  const std::string depth = sizeText(pair.depth->width, pair.depth->height);
  const std::string camera =
      sizeText(static_cast<std::size_t>(camera_.width), static_cast<std::size_t>(camera_.height));
  if (color == camera && depth == camera) return;
  if (returned_ > 0) {
    refuse(color == camera ? topics_.depth : topics_.color,
           "the image size changes in mid-stream, at " + std::to_string(stampOf(pair.depth)) +
               " s, from " + camera + " to " + (color == camera ? depth : color) +
               "; cut the bag there with rosbag filter and use the parts one by one");
  }
  refuse(topics_.depth, "depth is " + depth + ", colour " + color + ", camera_info " + camera +
                            ": all three must agree; record depth registered to colour at its "
                            "size");
}

RgbdFrame BagRecording::decode(const ImagePair& pair) {
  checkSizes(pair);
  RgbdFrame frame;
  frame.stamp = stampOf(pair.depth);
  frame.color_delay = stampOf(pair.color) - frame.stamp;
  try {
    frame.grey = greyFromMessage(*pair.color);
  } catch (const MessageError& error) {
    refuse(topics_.color, error.what());
  }
  try {
    frame.depth = depthFromMessage(*pair.depth);
  } catch (const MessageError& error) {
    refuse(topics_.depth, error.what());
  }
  last_color_ = pair.color;
  ++returned_;
  return frame;
}

cv::Mat BagRecording::color() const {
  if (!last_color_) return {};
  const std::string& encoding = last_color_->encoding;
  const bool four = encoding == "rgba8" || encoding == "bgra8" || encoding == "8UC4";
  const bool three = encoding == "rgb8" || encoding == "bgr8" || encoding == "8UC3";
  if (!three && !four) return {};
  // The message is only read; cv::Mat has no const view.
  const cv::Mat pixels(static_cast<int>(last_color_->height), static_cast<int>(last_color_->width),
                       four ? CV_8UC4 : CV_8UC3,
                       const_cast<std::uint8_t*>(last_color_->data.data()), last_color_->step);
  if (encoding == "bgr8" || encoding == "8UC3") return pixels.clone();
  cv::Mat bgr;
  cv::cvtColor(pixels, bgr,
               encoding == "rgb8"    ? cv::COLOR_RGB2BGR
               : encoding == "rgba8" ? cv::COLOR_RGBA2BGR
                                     : cv::COLOR_BGRA2BGR);
  return bgr;
}

std::vector<std::unique_ptr<Recording>> openBag(
    const std::string& path, const std::function<void(const std::string&)>& warn) {
  const BagSource source = openSource(path, warn);
  rosbag::Bag bag;
  openFile(source.file(), bag);
  std::vector<std::unique_ptr<Recording>> recordings;
  for (RobotTopics& topics : findRobots(path, topicsOf(bag))) {
    recordings.push_back(std::make_unique<BagRecording>(source, std::move(topics)));
  }
  return recordings;
}

}  // namespace planecloud

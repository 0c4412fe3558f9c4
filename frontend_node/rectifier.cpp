// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/frontend_node/rectifier.h"

#include <cstdint>
#include <limits>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace planecloud {

/// Where each rectified pixel comes from.
struct Rectifier::Maps {
  cv::Mat pixel;                      ///< CV_16SC2, fixed-point map of cv::remap
  cv::Mat fraction;                   ///< CV_16UC1, of the same
  std::vector<std::int32_t> nearest;  ///< index of the nearest pixel, -1: outside
};

Rectifier::Rectifier(const CameraIntrinsics& camera)
    : rectified_(camera.rectified()), maps_(std::make_unique<Maps>()) {
  camera.check();
  const Camera distorted(camera);
  cv::Mat map_x(camera.height, camera.width, CV_32FC1);
  cv::Mat map_y(camera.height, camera.width, CV_32FC1);
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const Eigen::Vector2d source =
          distorted.project({(x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy, 1.0});
      map_x.at<float>(y, x) = static_cast<float>(source.x());
      map_y.at<float>(y, x) = static_cast<float>(source.y());
    }
  }
  cv::convertMaps(map_x, map_y, maps_->pixel, maps_->fraction, CV_16SC2, false);
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const int column = cvRound(map_x.at<float>(y, x));
      const int row = cvRound(map_y.at<float>(y, x));
      const bool inside = column >= 0 && column < camera.width && row >= 0 && row < camera.height;
      maps_->nearest.push_back(inside ? row * camera.width + column : -1);
    }
  }
}

Rectifier::~Rectifier() = default;
Rectifier::Rectifier(Rectifier&&) noexcept = default;
Rectifier& Rectifier::operator=(Rectifier&&) noexcept = default;

RgbdFrame Rectifier::rectify(const RgbdFrame& frame) const {
  RgbdFrame rectified;
  rectify(frame, rectified);
  return rectified;
}

void Rectifier::rectify(const RgbdFrame& frame, RgbdFrame& rectified) const {
  const int width = rectified_.width;
  const int height = rectified_.height;
  rectified.stamp = frame.stamp;
  rectified.grey.resize(width, height);
  rectified.depth.resize(width, height);
  // cv::Mat has no read-only form; remap does not write to its source.
  const cv::Mat grey(height, width, CV_8UC1, const_cast<std::uint8_t*>(frame.grey.begin()));
  cv::Mat grey_out(height, width, CV_8UC1, rectified.grey.begin());
  cv::remap(grey, grey_out, maps_->pixel, maps_->fraction, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  const float* depth = frame.depth.begin();
  float* depth_out = rectified.depth.begin();
  for (const std::int32_t from : maps_->nearest) {
    *depth_out++ = from < 0 ? std::numeric_limits<float>::quiet_NaN() : depth[from];
  }
  rectified.color.resize(frame.color.width(), frame.color.height());
  if (!frame.color.empty()) {
    const cv::Mat color(height, width, CV_8UC3, const_cast<Rgb8*>(frame.color.begin()));
    cv::Mat color_out(height, width, CV_8UC3, rectified.color.begin());
    cv::remap(color, color_out, maps_->pixel, maps_->fraction, cv::INTER_LINEAR,
              cv::BORDER_REPLICATE);
  }
}

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/frontend_node/rectifier.h"

#include <limits>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace planecloud {

/// Fixed-point maps of cv::remap: where each rectified pixel comes from.
struct Rectifier::Maps {
  cv::Mat pixel;     ///< CV_16SC2
  cv::Mat fraction;  ///< CV_16UC1
  cv::Mat nearest;   ///< CV_16SC2, rounded
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
  cv::Mat unused;
  cv::convertMaps(map_x, map_y, maps_->nearest, unused, CV_16SC2, true);
}

Rectifier::~Rectifier() = default;
Rectifier::Rectifier(Rectifier&&) noexcept = default;
Rectifier& Rectifier::operator=(Rectifier&&) noexcept = default;

RgbdFrame Rectifier::rectify(const RgbdFrame& frame) const {
  const int width = rectified_.width;
  const int height = rectified_.height;
  RgbdFrame rectified;
  rectified.stamp = frame.stamp;
  rectified.grey = Image<std::uint8_t>(width, height);
  rectified.depth = Image<float>(width, height);
  // cv::Mat has no read-only form; remap does not write to its source.
  const cv::Mat grey(height, width, CV_8UC1, const_cast<std::uint8_t*>(frame.grey.begin()));
  const cv::Mat depth(height, width, CV_32FC1, const_cast<float*>(frame.depth.begin()));
  cv::Mat grey_out(height, width, CV_8UC1, rectified.grey.begin());
  cv::Mat depth_out(height, width, CV_32FC1, rectified.depth.begin());
  cv::remap(grey, grey_out, maps_->pixel, maps_->fraction, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  cv::remap(depth, depth_out, maps_->nearest, cv::Mat(), cv::INTER_NEAREST, cv::BORDER_CONSTANT,
            cv::Scalar(std::numeric_limits<double>::quiet_NaN()));
  if (!frame.color.empty()) {
    rectified.color = Image<Rgb8>(width, height);
    const cv::Mat color(height, width, CV_8UC3, const_cast<Rgb8*>(frame.color.begin()));
    cv::Mat color_out(height, width, CV_8UC3, rectified.color.begin());
    cv::remap(color, color_out, maps_->pixel, maps_->fraction, cv::INTER_LINEAR,
              cv::BORDER_REPLICATE);
  }
  return rectified;
}

}  // namespace planecloud

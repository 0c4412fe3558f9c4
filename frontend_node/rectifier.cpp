// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/frontend_node/rectifier.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "planecloud_slam/frontend_node/remap_kernel.h"

namespace planecloud {

/// Where each rectified pixel comes from.
struct Rectifier::Maps {
  std::vector<std::int32_t> at;  ///< see RemapRow
  std::vector<std::uint8_t> right, down;
  cv::Mat pixel;     ///< CV_16SC2, fixed-point map of cv::remap
  cv::Mat fraction;  ///< CV_16UC1, of the same

  void add(const Eigen::Vector2d& source, int width, int height);
};

void Rectifier::Maps::add(const Eigen::Vector2d& source, int width, int height) {
  const Eigen::Vector2d last(width - 1, height - 1);
  const Eigen::Vector2d inside = source.cwiseMax(0.0).cwiseMin(last);
  // As far as the next pixel, so that the nearest one is within half a pixel of the image.
  const bool is_inside = (source - inside).cwiseAbs().maxCoeff() <= 0.5;
  const int column = std::min(static_cast<int>(inside.x()), width - 2);
  const int row = std::min(static_cast<int>(inside.y()), height - 2);
  const std::int32_t index = row * width + column;
  at.push_back(is_inside ? index : ~index);
  right.push_back(static_cast<std::uint8_t>(std::lround(kRemapSteps * (inside.x() - column))));
  down.push_back(static_cast<std::uint8_t>(std::lround(kRemapSteps * (inside.y() - row))));
}

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
      maps_->add(source, camera.width, camera.height);
    }
  }
  cv::convertMaps(map_x, map_y, maps_->pixel, maps_->fraction, CV_16SC2, false);
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
  vectorRemap()({frame.grey.begin(), frame.depth.begin(), width},
                {maps_->at.data(), maps_->right.data(), maps_->down.data()}, maps_->at.size(),
                rectified.grey.begin(), rectified.depth.begin());
  rectified.color.resize(frame.color.width(), frame.color.height());
  if (!frame.color.empty()) {
    // cv::Mat has no read-only form; remap does not write to its source.
    const cv::Mat color(height, width, CV_8UC3, const_cast<Rgb8*>(frame.color.begin()));
    cv::Mat color_out(height, width, CV_8UC3, rectified.color.begin());
    cv::remap(color, color_out, maps_->pixel, maps_->fraction, cv::INTER_LINEAR,
              cv::BORDER_REPLICATE);
  }
}

}  // namespace planecloud

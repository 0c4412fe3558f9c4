// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core.hpp>

#include "planecloud_slam/plane_fit/image_view.h"
#include "planecloud_slam/plane_fit/rgb8.h"

namespace planecloud {

/// OpenCV's 8UC3, blue first, as pixels of the core; empty for an empty one.
[[nodiscard]] inline Image<Rgb8> toRgb8(const cv::Mat& bgr) {
  Image<Rgb8> image(bgr.cols, bgr.rows);
  for (int y = 0; y < bgr.rows; ++y) {
    for (int x = 0; x < bgr.cols; ++x) {
      const auto& pixel = bgr.at<cv::Vec3b>(y, x);
      image(x, y) = {pixel[2], pixel[1], pixel[0]};
    }
  }
  return image;
}

}  // namespace planecloud

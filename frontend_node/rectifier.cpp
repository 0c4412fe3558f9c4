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

namespace {

/// [px] No image is larger, and no sum of spans beyond what an integer holds.
constexpr double kFarthest = 16000.0;

std::int32_t toUnits(double pixels) {
  return static_cast<std::int32_t>(std::lround(kRemapUnit * pixels));
}

/// Where a pixel of `camera` without its distortion is seen with it; far off where it is nowhere.
Eigen::Vector2d findSource(const Camera& camera, int x, int y) {
  const CameraIntrinsics& lens = camera.intrinsics();
  const Eigen::Vector2d source =
      camera.project({(x - lens.cx) / lens.fx, (y - lens.cy) / lens.fy, 1.0});
  if (!source.allFinite()) return Eigen::Vector2d::Constant(-kFarthest);
  return source.cwiseMax(-kFarthest).cwiseMin(kFarthest);
}

/// Of the pixels from (x, y) on.
RemapSpan makeSpan(const Camera& camera, int x, int y) {
  const int last = std::min(x + kRemapSpan, camera.width()) - 1;
  const Eigen::Vector2d begin = findSource(camera, x, y);
  const Eigen::Vector2d step = (findSource(camera, last, y) - begin) / std::max(1, last - x);
  return {toUnits(begin.x()), toUnits(begin.y()), toUnits(step.x()), toUnits(step.y())};
}

}  // namespace

struct Rectifier::Maps {
  std::size_t spans_per_row = 0;
  std::vector<RemapSpan> spans;
  cv::Mat pixel;     ///< CV_16SC2, fixed-point map of cv::remap; empty before the first colours
  cv::Mat fraction;  ///< CV_16UC1, of the same

  void makeColorMaps(int width, int height);
};

void Rectifier::Maps::makeColorMaps(int width, int height) {
  cv::Mat x(height, width, CV_32FC1);
  cv::Mat y(height, width, CV_32FC1);
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      const RemapSpan& span = spans[static_cast<std::size_t>(row) * spans_per_row +
                                    static_cast<std::size_t>(column / kRemapSpan)];
      const int steps = column % kRemapSpan;
      constexpr float kPixels = 1.0F / kRemapUnit;
      x.at<float>(row, column) = kPixels * static_cast<float>(span.x + steps * span.step_x);
      y.at<float>(row, column) = kPixels * static_cast<float>(span.y + steps * span.step_y);
    }
  }
  cv::convertMaps(x, y, pixel, fraction, CV_16SC2, false);
}

Rectifier::Rectifier(const CameraIntrinsics& camera)
    : rectified_(camera.rectified()), maps_(std::make_unique<Maps>()) {
  camera.check();
  const Camera distorted(camera);
  maps_->spans_per_row = static_cast<std::size_t>((camera.width + kRemapSpan - 1) / kRemapSpan);
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; x += kRemapSpan) {
      maps_->spans.push_back(makeSpan(distorted, x, y));
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
  const RemapSource source{frame.grey.begin(), frame.depth.begin(), width, height};
  for (int y = 0; y < height; ++y) {
    vectorRemap()(source, &maps_->spans[static_cast<std::size_t>(y) * maps_->spans_per_row],
                  static_cast<std::size_t>(width), rectified.grey.row(y), rectified.depth.row(y));
  }
  rectified.color.resize(frame.color.width(), frame.color.height());
  if (!frame.color.empty()) {
    if (maps_->pixel.empty()) maps_->makeColorMaps(width, height);
    // cv::Mat has no read-only form; remap does not write to its source.
    const cv::Mat color(height, width, CV_8UC3, const_cast<Rgb8*>(frame.color.begin()));
    cv::Mat color_out(height, width, CV_8UC3, rectified.color.begin());
    cv::remap(color, color_out, maps_->pixel, maps_->fraction, cv::INTER_LINEAR,
              cv::BORDER_REPLICATE);
  }
}

}  // namespace planecloud

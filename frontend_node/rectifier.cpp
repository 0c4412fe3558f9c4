// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/frontend_node/rectifier.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "planecloud_slam/frontend_node/half_remap_kernel.h"

namespace planecloud {
namespace {

/// First tap, `last` at most, and fraction of a mean over two samples around `centre`.
struct HalfSample {
  HalfSample(double centre, int last)
      : first(std::clamp(static_cast<int>(std::floor(centre - 0.5)), 0, last)),
        fraction(static_cast<std::uint8_t>(
            std::lround(kHalfRemapSteps * std::clamp(centre - 0.5 - first, 0.0, 1.0)))) {}
  int first;
  std::uint8_t fraction;
};

template <class Pixel>
void remap(const Image<Pixel>& source, int type, const cv::Mat& pixel, const cv::Mat& fraction,
           Image<Pixel>& made) {
  made.resize(source.width(), source.height());
  if (source.empty()) return;
  // cv::Mat has no read-only form; remap does not write to its source.
  const cv::Mat from(source.height(), source.width(), type, const_cast<Pixel*>(source.begin()));
  cv::Mat to(source.height(), source.width(), type, made.begin());
  cv::remap(from, to, pixel, fraction, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
}

}  // namespace

/// Where each rectified pixel comes from.
struct Rectifier::Maps {
  cv::Mat pixel;     ///< CV_16SC2, fixed-point map of cv::remap
  cv::Mat fraction;  ///< CV_16UC1, of the same

  std::vector<std::int32_t> nearest;  ///< index of the pixel nearest to it, in the image
  std::vector<std::size_t> outside;   ///< pixels of which none is within half a pixel

  std::vector<std::int32_t> half_at;  ///< see HalfRemapRow
  std::vector<std::uint8_t> half_right, half_down;

  void addNearest(const Eigen::Vector2d& source, int width, int height);
  void addHalf(const Eigen::Vector2d& centre, int width, int height);
};

void Rectifier::Maps::addNearest(const Eigen::Vector2d& source, int width, int height) {
  const Eigen::Vector2d inside =
      source.cwiseMax(0.0).cwiseMin(Eigen::Vector2d(width - 1, height - 1));
  if ((source - inside).cwiseAbs().maxCoeff() > 0.5) outside.push_back(nearest.size());
  nearest.push_back(
      static_cast<std::int32_t>(std::lround(inside.y()) * width + std::lround(inside.x())));
}

void Rectifier::Maps::addHalf(const Eigen::Vector2d& centre, int width, int height) {
  // Three pixels in either direction are summed, but four of a row are read.
  const HalfSample across(centre.x(), width - 4);
  const HalfSample down(centre.y(), height - 3);
  half_at.push_back(down.first * width + across.first);
  half_right.push_back(across.fraction);
  half_down.push_back(down.fraction);
}

Rectifier::Rectifier(const CameraIntrinsics& camera)
    : rectified_(camera.rectified()), maps_(std::make_unique<Maps>()) {
  camera.check();
  const Camera distorted(camera);
  const auto source = [&](double x, double y) -> Eigen::Vector2d {
    return distorted.project({(x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy, 1.0});
  };
  cv::Mat map(camera.height, camera.width, CV_32FC2);
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const Eigen::Vector2d at = source(x, y);
      map.at<cv::Vec2f>(y, x) = {static_cast<float>(at.x()), static_cast<float>(at.y())};
      maps_->addNearest(at, camera.width, camera.height);
    }
  }
  for (int y = 0; y < camera.height / 2; ++y) {
    for (int x = 0; x < camera.width / 2; ++x) {
      maps_->addHalf(source(2.0 * x + 0.5, 2.0 * y + 0.5), camera.width, camera.height);
    }
  }
  cv::convertMaps(map, cv::noArray(), maps_->pixel, maps_->fraction, CV_16SC2, false);
}

Rectifier::~Rectifier() = default;
Rectifier::Rectifier(Rectifier&&) noexcept = default;
Rectifier& Rectifier::operator=(Rectifier&&) noexcept = default;

RgbdFrame Rectifier::rectify(const RgbdFrame& frame) const {
  RgbdFrame rectified;
  rectified.stamp = frame.stamp;
  rectifyDepth(frame.depth, rectified.depth);
  rectifyColors(frame, rectified);
  return rectified;
}

void Rectifier::rectifyDepth(const Image<float>& depth, Image<float>& rectified) const {
  rectified.resize(rectified_.width, rectified_.height);
  const float* from = depth.begin();
  float* to = rectified.begin();
  const std::int32_t* nearest = maps_->nearest.data();
  const std::size_t count = maps_->nearest.size();
  for (std::size_t i = 0; i < count; ++i) to[i] = from[nearest[i]];
  for (const std::size_t i : maps_->outside) to[i] = std::numeric_limits<float>::quiet_NaN();
}

void Rectifier::rectifyHalfGrey(const Image<std::uint8_t>& grey, Image<float>& rectified) const {
  rectified.resize(rectified_.width / 2, rectified_.height / 2);
  vectorHalfRemap()({grey.begin(), grey.width()},
                    {maps_->half_at.data(), maps_->half_right.data(), maps_->half_down.data()},
                    maps_->half_at.size(), rectified.begin());
}

void Rectifier::rectifyColors(const RgbdFrame& frame, RgbdFrame& rectified) const {
  remap(frame.grey, CV_8UC1, maps_->pixel, maps_->fraction, rectified.grey);
  remap(frame.color, CV_8UC3, maps_->pixel, maps_->fraction, rectified.color);
}

}  // namespace planecloud

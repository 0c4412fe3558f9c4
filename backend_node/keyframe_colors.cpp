// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/backend_node/keyframe_colors.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <optional>
#include <vector>

namespace planecloud {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// Size of a JPEG as its frame header says, found without decoding: a few bytes can announce an
/// image of gigabytes.
std::optional<cv::Size> jpegSize(const Bytes& bytes) {
  const auto word = [&](std::size_t at) { return bytes[at] << 8 | bytes[at + 1]; };
  std::size_t at = 2;
  while (at + 9 < bytes.size() && bytes[at] == 0xFF) {
    const int marker = bytes[at + 1];
    const bool is_frame =
        marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
    if (is_frame) return cv::Size(word(at + 7), word(at + 5));
    at += 2 + static_cast<std::size_t>(word(at + 2));
  }
  return std::nullopt;
}

cv::Mat decodeJpeg(const Bytes& bytes, const CameraIntrinsics& camera) {
  const std::optional<cv::Size> size = jpegSize(bytes);
  if (!size || size->width > camera.width || size->height > camera.height) return {};
  try {
    return cv::imdecode(bytes, cv::IMREAD_COLOR);
  } catch (const cv::Exception&) {
    return {};
  }
}

double mix(double a, double b, double share) { return a + share * (b - a); }

}  // namespace

KeyframeColors::KeyframeColors(const Keyframe& keyframe) : camera_(keyframe.planes.camera) {
  const cv::Mat picture = decodeJpeg(keyframe.texture.bytes, camera_);
  texture_ = Image<Rgb8>(picture.cols, picture.rows);
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.cols; ++x) {
      const auto& pixel = picture.at<cv::Vec3b>(y, x);
      texture_(x, y) = {pixel[2], pixel[1], pixel[0]};
    }
  }
}

Rgb8 KeyframeColors::at(const Eigen::Vector3d& point, const Rgb8& otherwise) const {
  if (empty()) return otherwise;
  const double u = camera_.fx * point.x() / point.z() + camera_.cx;
  const double v = camera_.fy * point.y() / point.z() + camera_.cy;
  const double x =
      std::clamp((u + 0.5) * texture_.width() / camera_.width - 0.5, 0.0, texture_.width() - 1.0);
  const double y = std::clamp((v + 0.5) * texture_.height() / camera_.height - 0.5, 0.0,
                              texture_.height() - 1.0);
  const int left = static_cast<int>(x);
  const int top = static_cast<int>(y);
  const int right = std::min(left + 1, texture_.width() - 1);
  const int bottom = std::min(top + 1, texture_.height() - 1);
  const auto channel = [&](std::uint8_t Rgb8::*c) {
    const double above = mix(texture_(left, top).*c, texture_(right, top).*c, x - left);
    const double below = mix(texture_(left, bottom).*c, texture_(right, bottom).*c, x - left);
    return static_cast<std::uint8_t>(std::lround(mix(above, below, y - top)));
  };
  return {channel(&Rgb8::r), channel(&Rgb8::g), channel(&Rgb8::b)};
}

}  // namespace planecloud

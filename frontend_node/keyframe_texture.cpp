// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/frontend_node/keyframe_texture.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <vector>

namespace planecloud {
namespace {

constexpr int kLowestQuality = 10;
constexpr int kSmallestSide = 8;  // [px]

/// cv::Mat has no read-only form; nobody writes to it here.
template <typename Pixel>
cv::Mat matOf(ImageView<Pixel> image, int type) {
  return {image.height(), image.width(), type, const_cast<Pixel*>(image.row(0)),
          static_cast<std::size_t>(image.stride()) * sizeof(Pixel)};
}

/// In OpenCV's order of channels.
cv::Mat pictureOf(ImageView<std::uint8_t> grey, ImageView<Rgb8> color) {
  if (color.empty()) return matOf(grey, CV_8UC1);
  cv::Mat picture;
  cv::cvtColor(matOf(color, CV_8UC3), picture, cv::COLOR_RGB2BGR);
  return picture;
}

cv::Mat scaled(const cv::Mat& picture, double scale) {
  const cv::Size size(std::max(1, static_cast<int>(std::lround(picture.cols * scale))),
                      std::max(1, static_cast<int>(std::lround(picture.rows * scale))));
  cv::Mat result;
  cv::resize(picture, result, size, 0.0, 0.0, cv::INTER_AREA);
  return result;
}

std::vector<std::uint8_t> encodeJpeg(const cv::Mat& picture, int quality) {
  std::vector<std::uint8_t> bytes;
  const std::vector<int> flags = {cv::IMWRITE_JPEG_QUALITY, quality, cv::IMWRITE_JPEG_OPTIMIZE, 1};
  if (!cv::imencode(".jpg", picture, bytes, flags)) {
    throw std::runtime_error("OpenCV cannot write JPEG: install its image codecs");
  }
  return bytes;
}

}  // namespace

std::string toString(TextureFormat format) {
  switch (format) {
    case TextureFormat::kNone:
      return "none";
    case TextureFormat::kGrey:
      return "grey";
    case TextureFormat::kColor:
      return "color";
  }
  throw std::invalid_argument("unknown texture format");
}

void fromString(const std::string& text, TextureFormat& format) {
  for (const TextureFormat choice :
       {TextureFormat::kNone, TextureFormat::kGrey, TextureFormat::kColor}) {
    if (toString(choice) != text) continue;
    format = choice;
    return;
  }
  throw std::invalid_argument("texture = " + text + ": must be one of none, grey, color");
}

void TextureOptions::check() const {
  checkRange("texture/scale", scale, 0.02, 1.0);
  checkRange("texture/quality", quality, 5, 100);
  checkRange("texture/max_share", max_share, 0.0, 1.0);
}

KeyframeTexture encodeTexture(ImageView<std::uint8_t> grey, ImageView<Rgb8> color,
                              const TextureOptions& options, std::size_t most_bytes) {
  if (options.format == TextureFormat::kNone || grey.empty()) return {};
  const bool is_color = options.format == TextureFormat::kColor && !color.empty();
  const cv::Mat picture = pictureOf(grey, is_color ? color : ImageView<Rgb8>());
  const int side = std::min(picture.cols, picture.rows);
  for (double scale = options.scale; side * scale >= kSmallestSide; scale /= 2.0) {
    const cv::Mat small = scaled(picture, scale);
    for (int quality = options.quality;; quality = std::max(kLowestQuality, quality / 2)) {
      std::vector<std::uint8_t> bytes = encodeJpeg(small, quality);
      if (bytes.size() <= most_bytes) {
        return {is_color ? "jpeg-color" : "jpeg-grey", std::move(bytes)};
      }
      if (quality <= kLowestQuality) break;
    }
  }
  return {};
}

}  // namespace planecloud

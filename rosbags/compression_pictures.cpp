// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/rosbags/compression_pictures.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "planecloud_slam/plane_fit/depth_traits.h"

namespace planecloud {
namespace {

constexpr float kNearest = 0.4F;      // [m]
constexpr float kFarthest = 8.0F;     // [m]
constexpr float kWorstError = 0.05F;  // [m]
constexpr double kTintShare = 0.35;

std::uint8_t toLevel(float share) {
  return static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(share, 0.0F, 1.0F)));
}

/// Colours from a surface's normal: x, y, z of the camera as red, green, blue.
cv::Scalar normalColor(const PlanarTile& tile) {
  const Eigen::Vector3d n = tile.plane().head<3>();
  return {127.5 * (1.0 - n.z()), 127.5 * (1.0 + n.y()), 127.5 * (1.0 + n.x())};
}

cv::Mat greyBackground(const Image<std::uint8_t>& grey) {
  cv::Mat picture(grey.height(), grey.width(), CV_8UC3);
  for (int y = 0; y < grey.height(); ++y) {
    for (int x = 0; x < grey.width(); ++x) {
      picture.at<cv::Vec3b>(y, x) = cv::Vec3b::all(grey(x, y));
    }
  }
  return picture;
}

void writePicture(const std::string& path, const cv::Mat& picture) {
  if (!cv::imwrite(path, picture)) throw std::runtime_error("cannot write '" + path + "'");
}

}  // namespace

cv::Mat drawDepth(const Image<float>& depth) {
  cv::Mat1b levels(depth.height(), depth.width(), std::uint8_t{0});
  cv::Mat1b missing(depth.height(), depth.width(), std::uint8_t{255});
  for (int y = 0; y < depth.height(); ++y) {
    for (int x = 0; x < depth.width(); ++x) {
      if (!hasDepth(depth(x, y))) continue;
      missing(y, x) = 0;
      levels(y, x) =
          toLevel((1.0F / depth(x, y) - 1.0F / kFarthest) / (1.0F / kNearest - 1.0F / kFarthest));
    }
  }
  cv::Mat picture;
  cv::applyColorMap(levels, picture, cv::COLORMAP_TURBO);
  picture.setTo(cv::Scalar::all(0), missing);
  return picture;
}

cv::Mat drawError(const Image<float>& depth, const Image<float>& restored) {
  cv::Mat1b levels(depth.height(), depth.width(), std::uint8_t{0});
  cv::Mat1b uncovered(levels.size(), std::uint8_t{0});
  cv::Mat1b missing(levels.size(), std::uint8_t{0});
  for (int y = 0; y < depth.height(); ++y) {
    for (int x = 0; x < depth.width(); ++x) {
      if (!hasDepth(depth(x, y))) {
        missing(y, x) = 255;
      } else if (!hasDepth(restored(x, y))) {
        uncovered(y, x) = 255;
      } else {
        levels(y, x) = toLevel(std::abs(depth(x, y) - restored(x, y)) / kWorstError);
      }
    }
  }
  cv::Mat picture;
  cv::applyColorMap(levels, picture, cv::COLORMAP_VIRIDIS);
  picture.setTo(cv::Scalar::all(128), uncovered);
  picture.setTo(cv::Scalar::all(0), missing);
  return picture;
}

cv::Mat drawTiles(const cv::Mat& background, const PlaneCloud& cloud) {
  cv::Mat picture = background.clone();
  for (const PlanarTile& tile : cloud.tiles) {
    const cv::Rect rect(tile.rect.x, tile.rect.y, tile.rect.width, tile.rect.height);
    const cv::Scalar color = normalColor(tile);
    cv::Mat inside = picture(rect);
    const cv::Mat tint(inside.size(), inside.type(), color);
    cv::addWeighted(inside, 1.0 - kTintShare, tint, kTintShare, 0.0, inside);
    cv::rectangle(picture, rect, color);
  }
  return picture;
}

cv::Mat drawTexture(const KeyframeTexture& texture, const Image<float>& restored) {
  const cv::Mat small = cv::imdecode(texture.bytes, cv::IMREAD_COLOR);
  if (small.empty()) throw std::runtime_error("the texture is no image");
  cv::Mat picture;
  cv::resize(small, picture, {restored.width(), restored.height()}, 0.0, 0.0, cv::INTER_LINEAR);
  for (int y = 0; y < restored.height(); ++y) {
    for (int x = 0; x < restored.width(); ++x) {
      if (!hasDepth(restored(x, y))) picture.at<cv::Vec3b>(y, x) = cv::Vec3b::all(0);
    }
  }
  return picture;
}

void writePictures(const std::string& prefix, const CompressionItem& item,
                   const CompressedFrame& compressed) {
  const cv::Mat background = item.color.empty() ? greyBackground(item.frame.grey) : item.color;
  writePicture(prefix + "_color.png", background);
  writePicture(prefix + "_sensor.png", drawDepth(item.frame.depth));
  writePicture(prefix + "_depth.png", drawDepth(compressed.depth));
  writePicture(prefix + "_error.png", drawError(item.frame.depth, compressed.depth));
  writePicture(prefix + "_tiles.png", drawTiles(background, compressed.cloud));
  if (compressed.texture.bytes.empty()) return;
  writePicture(prefix + "_texture.png", drawTexture(compressed.texture, compressed.depth));
}

}  // namespace planecloud

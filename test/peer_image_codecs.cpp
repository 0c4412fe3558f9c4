// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <vector>

#include "depth_codec_peers.h"

namespace planecloud {
namespace {

constexpr double kInverseDepthUnit = 2.0 / 65535.0;  // [1/m], 0.5 m and farther

/// Inverse depth; a hole continues its left neighbour, which costs a wavelet codec least.
cv::Mat1w toInverseDepth(const Image<float>& depth) {
  cv::Mat1w image(depth.height(), depth.width());
  for (int y = 0; y < depth.height(); ++y) {
    double last = 0.5;
    for (int x = 0; x < depth.width(); ++x) {
      if (depth(x, y) > 0.0F) last = 1.0 / static_cast<double>(depth(x, y));
      image(y, x) =
          static_cast<std::uint16_t>(std::min(65535.0, std::round(last / kInverseDepthUnit)));
    }
  }
  return image;
}

double meanError(const Image<float>& depth, const cv::Mat1w& image) {
  double sum = 0.0;
  double count = 0.0;
  for (int y = 0; y < depth.height(); ++y) {
    for (int x = 0; x < depth.width(); ++x) {
      if (!(depth(x, y) > 0.0F)) continue;
      const double q = std::max<double>(image(y, x), 1.0) * kInverseDepthUnit;
      sum += std::abs(1.0 / q - static_cast<double>(depth(x, y)));
      count += 1.0;
    }
  }
  return sum / std::max(1.0, count);
}

}  // namespace

CodedDepth encodeJpeg2000(const Image<float>& depth, double depth_error) {
  CodedDepth best;
  if (!cv::haveImageWriter(".jp2")) return best;
  const cv::Mat1w image = toInverseDepth(depth);
  int fine = 1000;  // [1/1000] of the uncompressed size
  int coarse = 0;
  while (fine - coarse > 1) {
    const int middle = (fine + coarse) / 2;
    std::vector<std::uint8_t> bytes;
    cv::imencode(".jp2", image, bytes, {cv::IMWRITE_JPEG2000_COMPRESSION_X1000, middle});
    const cv::Mat1w decoded = cv::imdecode(bytes, cv::IMREAD_UNCHANGED);
    const double error = meanError(depth, decoded);
    if (error <= depth_error) {
      fine = middle;
      best = {bytes.size(), error};
    } else {
      coarse = middle;
    }
  }
  return best;
}

CodedDepth encodePng(const Image<float>& depth) {
  cv::Mat1w image(depth.height(), depth.width(), std::uint16_t{0});
  for (int y = 0; y < depth.height(); ++y) {
    for (int x = 0; x < depth.width(); ++x) {
      if (depth(x, y) > 0.0F) {
        image(y, x) = static_cast<std::uint16_t>(std::lround(5000.0F * depth(x, y)));
      }
    }
  }
  std::vector<std::uint8_t> bytes;
  cv::imencode(".png", image, bytes, {cv::IMWRITE_PNG_COMPRESSION, 9});
  return {bytes.size(), 0.0};
}

}  // namespace planecloud

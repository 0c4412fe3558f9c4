// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/planecloud_msgs/image_conversions.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

namespace planecloud {
namespace {

constexpr std::uint32_t kMaxSide = 8192;  // [px], as CameraIntrinsics::check

constexpr bool kHostIsBigEndian = __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__;

struct ColorLayout {
  const char* encoding;
  std::uint32_t bytes;   // a pixel
  int red, green, blue;  // offsets [B]
};
constexpr ColorLayout kColorLayouts[] = {
    {"rgb8", 3, 0, 1, 2},  {"bgr8", 3, 2, 1, 0},  {"8UC3", 3, 2, 1, 0},
    {"rgba8", 4, 0, 1, 2}, {"bgra8", 4, 2, 1, 0}, {"8UC4", 4, 2, 1, 0},
};

[[noreturn]] void refuseEncoding(const std::string& what, const std::string& encoding,
                                 const std::string& supported) {
  refuseMessage(what + " image has encoding '" + encoding + "': must be " + supported);
}

void checkLayout(const sensor_msgs::Image& message, std::uint32_t pixel_bytes) {
  const std::string size = std::to_string(message.width) + " x " + std::to_string(message.height);
  if (message.width == 0 || message.height == 0 || message.width > kMaxSide ||
      message.height > kMaxSide) {
    refuseMessage("image of " + size + " pixels: both sides must be in [1, 8192]");
  }
  if (message.step < message.width * pixel_bytes) {
    refuseMessage("image of " + size + " in " + message.encoding + " has a row step of " +
                  std::to_string(message.step) + " bytes: must be at least " +
                  std::to_string(message.width * pixel_bytes));
  }
  const std::uint64_t bytes = std::uint64_t{message.step} * message.height;
  if (message.data.size() < bytes) {
    refuseMessage("image of " + size + " in " + message.encoding + " has " +
                  std::to_string(message.data.size()) + " bytes: must be " + std::to_string(bytes) +
                  "; it was truncated");
  }
}

const std::uint8_t* rowOf(const sensor_msgs::Image& message, int y) {
  return message.data.data() + static_cast<std::size_t>(y) * message.step;
}

/// Number `x` of a row, in the byte order the message says.
template <typename Number>
Number readNumber(const std::uint8_t* row, int x, bool swap) {
  std::uint8_t bytes[sizeof(Number)];
  std::memcpy(bytes, row + static_cast<std::size_t>(x) * sizeof(Number), sizeof(Number));
  if (swap) std::reverse(std::begin(bytes), std::end(bytes));
  Number number;
  std::memcpy(&number, bytes, sizeof(Number));
  return number;
}

bool needsSwap(const sensor_msgs::Image& message) {
  return (message.is_bigendian != 0) != kHostIsBigEndian;
}

/// An image whose pixel (x, y) is `convert(number)` of the message's single channel.
template <typename Number, typename Pixel, typename Convert>
Image<Pixel> convertChannel(const sensor_msgs::Image& message, Convert convert) {
  checkLayout(message, sizeof(Number));
  Image<Pixel> image(static_cast<int>(message.width), static_cast<int>(message.height));
  const bool swap = sizeof(Number) > 1 && needsSwap(message);
  for (int y = 0; y < image.height(); ++y) {
    const std::uint8_t* source = rowOf(message, y);
    Pixel* target = image.row(y);
    for (int x = 0; x < image.width(); ++x) {
      target[x] = convert(readNumber<Number>(source, x, swap));
    }
  }
  return image;
}

float depthOfMillimetres(std::uint16_t depth) {
  return depth == 0 ? std::numeric_limits<float>::quiet_NaN() : 0.001F * static_cast<float>(depth);
}

float depthOfMetres(float depth) {
  return std::isfinite(depth) && depth > 0.0F ? depth : std::numeric_limits<float>::quiet_NaN();
}

/// ITU-R BT.601 weights in 15 bits, rounded: OpenCV's integers.
std::uint8_t greyOf(int red, int green, int blue) {
  return static_cast<std::uint8_t>((9798 * red + 19235 * green + 3735 * blue + (1 << 14)) >> 15);
}

/// An image whose pixels are `convert(red, green, blue)` of the message's.
template <typename Pixel, typename Convert>
Image<Pixel> convertColor(const sensor_msgs::Image& message, const ColorLayout& layout,
                          Convert convert) {
  checkLayout(message, layout.bytes);
  Image<Pixel> image(static_cast<int>(message.width), static_cast<int>(message.height));
  for (int y = 0; y < image.height(); ++y) {
    const std::uint8_t* pixel = rowOf(message, y);
    Pixel* target = image.row(y);
    for (int x = 0; x < image.width(); ++x, pixel += layout.bytes) {
      target[x] = convert(pixel[layout.red], pixel[layout.green], pixel[layout.blue]);
    }
  }
  return image;
}

void readDistortion(const sensor_msgs::CameraInfo& message, CameraIntrinsics& camera) {
  const bool none =
      std::all_of(message.D.begin(), message.D.end(), [](double k) { return k == 0; });
  if (none) return;
  if (message.distortion_model != "plumb_bob" || message.D.size() > camera.distortion.size()) {
    refuseMessage("camera_info has distortion model '" + message.distortion_model + "' with " +
                  std::to_string(message.D.size()) +
                  " coefficients: must be 'plumb_bob' with at most 5; rectify the images "
                  "(image_proc) or calibrate with that model");
  }
  std::copy(message.D.begin(), message.D.end(), camera.distortion.begin());
}

}  // namespace

Image<float> depthFromMessage(const sensor_msgs::Image& message) {
  if (message.encoding == "16UC1" || message.encoding == "mono16") {
    return convertChannel<std::uint16_t, float>(message, depthOfMillimetres);
  }
  if (message.encoding == "32FC1") return convertChannel<float, float>(message, depthOfMetres);
  refuseEncoding("depth", message.encoding, "16UC1 (mm) or 32FC1 (m)");
}

Image<std::uint8_t> greyFromMessage(const sensor_msgs::Image& message) {
  if (message.encoding == "mono8" || message.encoding == "8UC1") {
    return convertChannel<std::uint8_t, std::uint8_t>(message, [](std::uint8_t v) { return v; });
  }
  if (message.encoding == "mono16") {
    return convertChannel<std::uint16_t, std::uint8_t>(
        message, [](std::uint16_t v) { return static_cast<std::uint8_t>(v >> 8); });
  }
  for (const ColorLayout& layout : kColorLayouts) {
    if (message.encoding == layout.encoding) {
      return convertColor<std::uint8_t>(message, layout, greyOf);
    }
  }
  refuseEncoding("colour", message.encoding,
                 "rgb8, bgr8, rgba8, bgra8, mono8, mono16, 8UC1, 8UC3 or 8UC4");
}

Image<Rgb8> colorFromMessage(const sensor_msgs::Image& message) {
  for (const ColorLayout& layout : kColorLayouts) {
    if (message.encoding != layout.encoding) continue;
    return convertColor<Rgb8>(message, layout,
                              [](std::uint8_t red, std::uint8_t green, std::uint8_t blue) {
                                return Rgb8{red, green, blue};
                              });
  }
  return {};
}

CameraIntrinsics fromMessage(const sensor_msgs::CameraInfo& message, bool rectified) {
  if (message.binning_x > 1 || message.binning_y > 1 || message.roi.width != 0 ||
      message.roi.height != 0) {
    refuseMessage("camera_info has binning or a region of interest: publish the full image");
  }
  CameraIntrinsics camera;
  camera.width = static_cast<int>(std::min(message.width, kMaxSide + 1));
  camera.height = static_cast<int>(std::min(message.height, kMaxSide + 1));
  camera.fx = rectified ? message.P[0] : message.K[0];
  camera.fy = rectified ? message.P[5] : message.K[4];
  camera.cx = rectified ? message.P[2] : message.K[2];
  camera.cy = rectified ? message.P[6] : message.K[5];
  if (camera.fx == 0.0 || camera.fy == 0.0) {
    refuseMessage(std::string("camera_info has no focal length in ") + (rectified ? "P" : "K") +
                  ": calibrate the camera (camera_calibration)");
  }
  if (!rectified) readDistortion(message, camera);
  try {
    camera.check();
  } catch (const std::invalid_argument& error) {
    refuseMessage(std::string("camera_info: ") + error.what());
  }
  return camera;
}

}  // namespace planecloud

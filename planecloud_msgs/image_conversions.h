// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include <cstdint>

#include "planecloud_slam/plane_fit/camera.h"
#include "planecloud_slam/plane_fit/image_view.h"
#include "planecloud_slam/plane_fit/rgb8.h"
#include "planecloud_slam/planecloud_msgs/message_error.h"

namespace planecloud {

/// Depth [m], NaN: none, of a 16UC1 (or mono16) image in mm with 0 = none, or of a 32FC1 one in m,
/// where what is not finite or not positive is none. Either byte order.
/// Throws MessageError for another encoding, naming it and these, and for a row step or a number of
/// bytes that does not fit the size.
[[nodiscard]] Image<float> depthFromMessage(const sensor_msgs::Image& message);

/// Grey levels 0..255 of mono8, 8UC1, mono16 (upper byte), rgb8, bgr8, 8UC3 (blue first), rgba8,
/// bgra8 or 8UC4 (blue first); colours are weighed as OpenCV's RGB2GRAY does, bit for bit. Throws
/// like `depthFromMessage`.
[[nodiscard]] Image<std::uint8_t> greyFromMessage(const sensor_msgs::Image& message);

/// Colours of the same encodings; empty for an image without colour. Throws like
/// `depthFromMessage`.
[[nodiscard]] Image<Rgb8> colorFromMessage(const sensor_msgs::Image& message);

/// Intrinsics of `P` when the images are `rectified` (D then speaks of the lens before it), else of
/// `K` and `D` (plumb_bob). Throws MessageError for an uncalibrated camera, another distortion
/// model, binning or a region of interest, and for intrinsics that fail their check.
[[nodiscard]] CameraIntrinsics fromMessage(const sensor_msgs::CameraInfo& message, bool rectified);

}  // namespace planecloud

// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core.hpp>
#include <string>

#include "planecloud_slam/plane_fit/image_view.h"
#include "planecloud_slam/plane_fit/plane_cloud.h"
#include "planecloud_slam/rosbags/compression_trial.h"

/// Pictures of one compressed frame, 8UC3, blue first.
namespace planecloud {

/// Depth [m] in colours from 0.4 m (red) to 8 m (blue), evenly in inverse depth; black: none.
[[nodiscard]] cv::Mat drawDepth(const Image<float>& depth);

/// Difference of both depths [m] in colours from 0 to 50 mm (dark to bright); grey: the sensor has
/// depth and the planes have none; black: the sensor has none.
[[nodiscard]] cv::Mat drawError(const Image<float>& depth, const Image<float>& restored);

/// The tiles over `background` (8UC3), tinted by the direction they face.
[[nodiscard]] cv::Mat drawTiles(const cv::Mat& background, const PlaneCloud& cloud);

/// The texture painted on the planes, seen from the camera that made them; black: no plane.
[[nodiscard]] cv::Mat drawTexture(const KeyframeTexture& texture, const Image<float>& restored);

/// Writes, each as <prefix>_<kind>.png, `color` and `sensor` (its depth), `depth` (the restored
/// one), `error`, `tiles` and, where there is one, `texture`; tiles over the grey image where there
/// is no colour. Throws std::runtime_error naming the file that cannot be written.
void writePictures(const std::string& prefix, const CompressionItem& item,
                   const CompressedFrame& compressed);

}  // namespace planecloud
